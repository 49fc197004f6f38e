#pragma once

#include <memory>
#include <tuple>

#include "common/base/clock.hpp"
#include "common/base/result.hpp"
#include "common/bus/bus_config.hpp"
#include "common/bus/events.hpp"
#include "common/bus/reader.hpp"
#include "common/bus/topics.hpp"
#include "common/bus/writer.hpp"

namespace limbcast::bus {

template <typename T>
struct TypeTag {};

/// The part of a bus that carries T.
template <typename T>
class BusPort {
 public:
  virtual ~BusPort() = default;

 protected:
  virtual Result<std::unique_ptr<Writer<T>>> DoMakeWriter(TypeTag<T>) = 0;
  virtual Result<std::unique_ptr<Reader<T>>> DoMakeReader(TypeTag<T>, ReaderHandler<T> handler) = 0;
};

template <typename List>
class BusPorts;
template <typename... Ts>
class BusPorts<std::tuple<Ts...>> : public BusPort<Ts>... {
 public:
  ~BusPorts() override = default;

 protected:
  using BusPort<Ts>::DoMakeWriter...;
  using BusPort<Ts>::DoMakeReader...;
};

/// One participant on one network. Makes typed writers and readers for every topic of AllTopics.
/// Thread-safe. It must outlive the writers and readers it made. Make one with Open
/// (bus_factory.hpp), or an inproc one for tests.
class Bus : public BusPorts<AllTopics> {
 public:
  ~Bus() override = default;

  template <typename T>
  [[nodiscard]] Result<std::unique_ptr<Writer<T>>> MakeWriter() {
    return DoMakeWriter(TypeTag<T>{});
  }
  template <typename T>
  [[nodiscard]] Result<std::unique_ptr<Reader<T>>> MakeReader(ReaderHandler<T> handler) {
    return DoMakeReader(TypeTag<T>{}, std::move(handler));
  }

  /// One line for a log: library and version, domain, partition, interfaces and peers in use.
  [[nodiscard]] virtual std::string Describe() const = 0;
};

}  // namespace limbcast::bus
