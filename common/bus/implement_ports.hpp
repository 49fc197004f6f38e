#pragma once

#include <memory>
#include <tuple>
#include <utility>

#include "common/bus/bus.hpp"

namespace limbcast::bus {

/// Overrides Bus' ports for each type of a list with two member templates of Derived:
///   template <typename T> Result<std::unique_ptr<Writer<T>>> MakeTypedWriter();
///   template <typename T> Result<std::unique_ptr<Reader<T>>> MakeTypedReader(ReaderHandler<T>);
/// Use: class InprocBus final : public ImplementPorts<InprocBus, AllTopics> { friend
/// ImplementPorts...; ... }.
template <typename Derived, typename List>
class ImplementPorts;

template <typename Derived>
class ImplementPorts<Derived, std::tuple<>> : public Bus {};

template <typename Derived, typename T, typename... Rest>
class ImplementPorts<Derived, std::tuple<T, Rest...>>
    : public ImplementPorts<Derived, std::tuple<Rest...>> {
  using Base = ImplementPorts<Derived, std::tuple<Rest...>>;

 protected:
  using Base::DoMakeReader;
  using Base::DoMakeWriter;
  Result<std::unique_ptr<Writer<T>>> DoMakeWriter(TypeTag<T> /*tag*/) final {
    return static_cast<Derived*>(this)->template MakeTypedWriter<T>();
  }
  Result<std::unique_ptr<Reader<T>>> DoMakeReader(TypeTag<T> /*tag*/,
                                                  ReaderHandler<T> handler) final {
    return static_cast<Derived*>(this)->template MakeTypedReader<T>(std::move(handler));
  }
};

}  // namespace limbcast::bus
