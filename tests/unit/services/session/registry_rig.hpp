#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/inproc/inproc_bus.hpp"
#include "services/session/session_registry.hpp"

namespace limbcast::session {

inline constexpr Time kStart = TimeFromNanoseconds(1'700'000'000'000'000'000);

inline std::unique_ptr<bus::Bus> InPartition(std::shared_ptr<bus::inproc::Hub> hub,
                                             std::string partition) {
  bus::BusConfig config;
  config.partition = std::move(partition);
  return bus::inproc::MakeBus(std::move(hub), config);
}

inline roster::SensorAssignment On(body::Segment segment, std::uint64_t uid) {
  return {.sensor_uid = SensorUid{uid}, .segment = segment};
}

inline roster::JoinRequest Asks(std::uint64_t client, std::string person,
                                std::vector<roster::SensorAssignment> sensors,
                                std::uint64_t request_id = 1) {
  return {.client_uid = client,
          .request_id = request_id,
          .session = "stage",
          .person = std::move(person),
          .role = roster::Role::kPerformer,
          .sensors = std::move(sensors),
          .wants_coil_slot = true};
}
/// A performer who does not say what it wears.
inline roster::JoinRequest AsksBare(std::uint64_t client, std::string person) {
  return Asks(client, std::move(person), std::vector<roster::SensorAssignment>{});
}
/// A performer with one sensor on the pelvis.
inline roster::JoinRequest Asks(std::uint64_t client, std::string person, std::uint64_t uid,
                                std::uint64_t request_id = 1) {
  return Asks(client, std::move(person), {On(body::Segment::kPelvis, uid)}, request_id);
}
inline roster::JoinRequest Watches(std::uint64_t client, roster::Role role,
                                   std::string person = "guest") {
  roster::JoinRequest request = AsksBare(client, std::move(person));
  request.role = role;
  return request;
}
inline roster::Command Command(std::uint64_t client, roster::CommandKind kind,
                               std::string text = "") {
  return {.client_uid = client,
          .request_id = 1,
          .body_id = {},
          .kind = kind,
          .text = std::move(text),
          .numbers = {}};
}

}  // namespace limbcast::session
