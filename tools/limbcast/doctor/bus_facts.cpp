#include "tools/limbcast/doctor/bus_facts.hpp"

#include <algorithm>
#include <utility>

namespace limbcast::tool {

void BusFacts::Note(const bus::BusEvent& event) {
  if (event.kind == bus::BusEventKind::kIncompatibleQos ||
      event.kind == bus::BusEventKind::kTypeMismatch) {
    const std::scoped_lock lock(mutex_);
    mismatches_.insert({event.kind, std::string(event.topic), event.detail});
  }
}

void BusFacts::Take(const ServiceHealth& health, Time received_at) {
  const std::scoped_lock lock(mutex_);
  ProcessFacts& process = processes_[health.process_uid];
  process.process_uid = health.process_uid;
  process.role = health.role;
  process.host = health.host;
  process.pid = health.pid;
  process.last_error = health.last_error;
  const Duration age = received_at - health.reported_at;
  process.smallest_age = process.reports == 0 ? age : std::min(process.smallest_age, age);
  ++process.reports;
}

void BusFacts::Take(const sensing::MargSample& sample) {
  SensorFacts& sensor = sensors_[sample.sensor_uid];
  std::uint32_t& last = sequences_[sample.sensor_uid];
  sensor.steps_back += sensor.samples > 0 && sample.sequence <= last ? 1U : 0U;
  last = sample.sequence;
  ++sensor.samples;
}

template <typename T, typename Use>
Status BusFacts::Hear(bus::Bus& bus, std::unique_ptr<bus::Reader<T>>& reader, Use use) {
  auto made = bus.MakeReader<T>({.on_sample = std::move(use), .on_disposed = {}});
  if (!made) {
    return made.error();
  }
  reader = std::move(*made);
  return Ok();
}

Status BusFacts::Listen(bus::Bus& bus) {
  using bus::SampleInfo;
  Status made = Hear<ServiceHealth>(
      bus, health_,
      [this](const auto& health, const SampleInfo& info) { Take(health, info.received_at); });
  made = made ? Hear<sensing::SensorInfo>(bus, info_,
                                          [this](const auto& info, const SampleInfo&) {
                                            const std::scoped_lock lock(mutex_);
                                            sensors_[info.sensor_uid].serial = info.serial;
                                          })
              : made;
  made = made ? Hear<roster::RosterEntry>(bus, roster_,
                                          [this](const auto& entry, const SampleInfo&) {
                                            const std::scoped_lock lock(mutex_);
                                            for (const auto& assigned : entry.sensors) {
                                              wearers_[assigned.sensor_uid].insert(
                                                  '"' + entry.person + "\" (body " +
                                                  std::to_string(entry.body_id.value) + ')');
                                            }
                                          })
              : made;
  made = made ? Hear<sensing::MargSample>(bus, marg_,
                                          [this](const auto& sample, const SampleInfo&) {
                                            const std::scoped_lock lock(mutex_);
                                            Take(sample);
                                          })
              : made;
  made = made ? Hear<sensing::MargFrame>(bus, frames_,
                                         [this](const auto& frame, const SampleInfo&) {
                                           const std::scoped_lock lock(mutex_);
                                           for (const auto& sample : frame.samples) {
                                             Take(sample);
                                           }
                                         })
              : made;
  // Only to be matched, or not.
  made =
      made ? Hear<body::SegmentState>(bus, states_, [](const auto&, const SampleInfo&) {}) : made;
  return made ? Hear<body::Skeleton>(bus, skeletons_, [](const auto&, const SampleInfo&) {}) : made;
}

void BusFacts::Leave() {
  health_.reset();
  info_.reset();
  marg_.reset();
  frames_.reset();
  roster_.reset();
  states_.reset();
  skeletons_.reset();
}

void BusFacts::Fill(DoctorFacts& facts) const {
  facts.peers_matched = 0;
  const auto count = [&](const auto& reader) {
    facts.peers_matched += reader != nullptr ? reader->counters().matched : 0;
  };
  count(health_);
  count(info_);
  count(marg_);
  count(frames_);
  count(roster_);
  count(states_);
  count(skeletons_);
  const std::scoped_lock lock(mutex_);
  facts.processes = processes_;
  facts.sensors = sensors_;
  for (const auto& [uid, people] : wearers_) {
    facts.sensors[uid].wearers.assign(people.begin(), people.end());
  }
  facts.mismatches.assign(mismatches_.begin(), mismatches_.end());
}

}  // namespace limbcast::tool
