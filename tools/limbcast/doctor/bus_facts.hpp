#pragma once

#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "common/base/result.hpp"
#include "common/bus/bus.hpp"
#include "tools/limbcast/doctor/doctor_facts.hpp"

namespace limbcast::tool {

/// Listens to what says something about the state of a network. Thread-safe.
class BusFacts {
 public:
  /// For bus::Open, before Listen.
  [[nodiscard]] bus::BusEventHandler handler() {
    return [this](const bus::BusEvent& event) { Note(event); };
  }
  /// Once. Fails when the bus refuses a reader. Leave comes before the end of `bus`.
  [[nodiscard]] Status Listen(bus::Bus& bus);
  void Leave();

  /// Writes what is known into `facts`.
  void Fill(DoctorFacts& facts) const;

 private:
  void Note(const bus::BusEvent& event);
  void Take(const ServiceHealth& health, Time received_at);
  void Take(const sensing::MargSample& sample);
  template <typename T, typename Use>
  [[nodiscard]] Status Hear(bus::Bus& bus, std::unique_ptr<bus::Reader<T>>& reader, Use use);

  mutable std::mutex mutex_;  // guards the next five
  std::map<std::uint64_t, ProcessFacts> processes_;
  std::map<SensorUid, SensorFacts> sensors_;
  std::map<SensorUid, std::uint32_t> sequences_;
  std::map<SensorUid, std::set<std::string>> wearers_;
  std::set<Mismatch> mismatches_;

  std::unique_ptr<bus::Reader<ServiceHealth>> health_;
  std::unique_ptr<bus::Reader<sensing::SensorInfo>> info_;
  std::unique_ptr<bus::Reader<sensing::MargSample>> marg_;
  std::unique_ptr<bus::Reader<sensing::MargFrame>> frames_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> roster_;
  std::unique_ptr<bus::Reader<body::SegmentState>> states_;
  std::unique_ptr<bus::Reader<body::Skeleton>> skeletons_;
};

}  // namespace limbcast::tool
