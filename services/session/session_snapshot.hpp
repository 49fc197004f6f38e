#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/time.hpp"
#include "common/roster/roster.hpp"

namespace limbcast::session {

/// A performer of a session, there or remembered.
struct KnownPerson {
  std::string person;
  BodyId body_id;
  std::uint64_t client_uid = 0;  ///< whoever joined for this person last
  std::uint32_t revision = 0;
  std::uint32_t coil_slot = 0;  ///< 0 = none; of a person who left: what it had
  bool here = false;            ///< in the roster
  Time left_at{};               ///< of a person who left
  std::vector<roster::SensorAssignment> sensors;
  bool operator==(const KnownPerson&) const = default;
};

struct KnownSession {
  std::uint32_t session_id = 0;
  std::uint32_t revision = 0;
  std::string name;
  Time created_at{};
  std::vector<KnownPerson> people;
  bool operator==(const KnownSession&) const = default;
};

/// What survives a restart of the session host.
struct SessionSnapshot {
  std::uint32_t next_session_id = 1;
  std::uint32_t next_body_id = 1;  ///< numbers are never given twice
  std::vector<KnownSession> sessions;
  bool operator==(const SessionSnapshot&) const = default;
};

}  // namespace limbcast::session
