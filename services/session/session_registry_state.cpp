// The state of a SessionRegistry: who wears what, what is told to the world, what is kept.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "services/session/session_names.hpp"
#include "services/session/session_registry.hpp"

namespace limbcast::session {

Status Validate(const RegistryLimits& limits) {
  struct Range {
    const char* name;
    double value, low, high;
  };
  const std::array ranges = {
      Range{"max_sessions", static_cast<double>(limits.max_sessions), 1, 100},
      Range{"max_members", static_cast<double>(limits.max_members), 1, 4096},
      Range{"max_members_of_client", static_cast<double>(limits.max_members_of_client), 1, 4096},
      Range{"max_remembered", static_cast<double>(limits.max_remembered), 0, 65536},
      Range{"lease_s", ToSeconds(limits.lease), 1, 60},
      Range{"grace_s", ToSeconds(limits.grace), 0, 86400},
      Range{"new_members_per_s", limits.new_members_per_s, 1, 1e5},
      Range{"coil_slots", static_cast<double>(limits.coil_slots), 0, 1000},
      Range{"coil_frame_us", static_cast<double>(limits.coil_frame_us), 1000, 1e9},
  };
  for (const Range& range : ranges) {
    if (!(range.value >= range.low && range.value <= range.high)) {
      return Error{ErrorCode::kInvalidArgument,
                   fmt::format("session.{} must be in [{}, {}], is {}", range.name, range.low,
                               range.high, range.value)};
    }
  }
  return Ok();
}

// The lowest free one, or the one it had when that is free.
std::uint32_t SessionRegistry::FreeSlot(const Session& session, std::uint32_t preferred) const {
  std::set<std::uint32_t> taken;
  for (const auto& [name, person] : session.people) {
    if (person.known.here) {
      taken.insert(person.known.coil_slot);
    }
  }
  // The person itself counts as here by now, with the slot it had.
  const auto holders =
      std::count_if(session.people.begin(), session.people.end(), [&](const auto& entry) {
        return entry.second.known.here && entry.second.known.coil_slot == preferred;
      });
  if (preferred >= 1 && preferred <= limits_.coil_slots && holders == 1) {
    return preferred;
  }
  for (std::uint32_t slot = 1; slot <= limits_.coil_slots; ++slot) {
    if (!taken.contains(slot)) {
      return slot;
    }
  }
  return 0;
}

void SessionRegistry::Wear(const Session& session, Person& person,
                           std::vector<roster::SensorAssignment> sensors, Time now) {
  Unwear(session, person);
  person.known.sensors = std::move(sensors);
  for (const roster::SensorAssignment& sensor : person.known.sensors) {
    const auto wearer = wearers_.find(sensor.sensor_uid);
    if (wearer != wearers_.end()) {  // vanished, says CheckFree; and somebody has its sensors now
      Session& its_session = sessions_.at(wearer->second.session);
      Release(its_session, its_session.people.at(wearer->second.person), now);
      ++counters_.released;
    }
    wearers_[sensor.sensor_uid] = {session.known.name, person.known.person};
  }
}

// A person who returns wears nothing yet, and somebody else may wear what it had.
void SessionRegistry::Unwear(const Session& session, const Person& person) {
  for (const roster::SensorAssignment& sensor : person.known.sensors) {
    const auto wearer = wearers_.find(sensor.sensor_uid);
    if (wearer != wearers_.end() && wearer->second.session == session.known.name &&
        wearer->second.person == person.known.person) {
      wearers_.erase(wearer);
    }
  }
}

void SessionRegistry::Release(Session& session, Person& person, Time now) {
  Unwear(session, person);
  Count(session, person.known.client_uid, -1);
  person.known.here = false;
  person.known.left_at = now;
  person.alive = false;
  --performers_;
  --session.performers;
  ++remembered_;
  changes_.emplace_back(EntryGone{EntryOf(session, person)});
  PassSlotOn(session, person);
  Changed(session);
  dirty_ = true;
}

// Whoever has waited longest for one: body ids are given in the order of coming.
void SessionRegistry::PassSlotOn(Session& session, const Person& from) {
  if (from.known.coil_slot == 0) {
    return;
  }
  Person* first = nullptr;
  for (auto& [name, person] : session.people) {
    const bool waits = person.known.here && person.wants_coil_slot && person.known.coil_slot == 0;
    if (waits && (first == nullptr || person.known.body_id < first->known.body_id)) {
      first = &person;
    }
  }
  if (first == nullptr) {
    return;
  }
  first->known.coil_slot = from.known.coil_slot;
  ++first->known.revision;
  changes_.emplace_back(EntryChanged{EntryOf(session, *first)});
}

void SessionRegistry::Close(Session& session) {
  for (auto& [name, person] : session.people) {
    if (person.known.here) {
      Unwear(session, person);
      changes_.emplace_back(EntryGone{EntryOf(session, person)});
    } else {
      --remembered_;
    }
  }
  performers_ -= session.performers;
  watchers_ -= session.watchers.size();
  changes_.emplace_back(SessionClosed{StateOf(session)});
  dirty_ = true;
  const std::string name = session.known.name;  // goes with the session
  sessions_.erase(name);
}

void SessionRegistry::ForgetOldest() {
  if (remembered_ <= limits_.max_remembered) {
    return;
  }
  std::vector<std::pair<Time, std::pair<Session*, std::string>>> gone;
  for (auto& [name, session] : sessions_) {
    for (const auto& [person_name, person] : session.people) {
      if (!person.known.here) {
        gone.push_back({person.known.left_at, {&session, person_name}});
      }
    }
  }
  std::sort(gone.begin(), gone.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; remembered_ > limits_.max_remembered; ++i) {
    const auto& [session, person_name] = gone[i].second;
    session->people.erase(person_name);
    --remembered_;
  }
  dirty_ = true;
}

void SessionRegistry::Changed(Session& session) {
  ++session.known.revision;
  session.changed = true;
}

void SessionRegistry::Count(Session& session, std::uint64_t client_uid, int more) {
  std::size_t& count = session.members_of_client[client_uid];
  count += static_cast<std::size_t>(more);  // more < 0 takes away, by modulo arithmetic
  if (count == 0) {
    session.members_of_client.erase(client_uid);
  }
}

std::vector<Change> SessionRegistry::TakeChanges() {
  for (auto& [name, session] : sessions_) {
    if (std::exchange(session.changed, false)) {
      changes_.emplace_back(SessionChanged{StateOf(session)});
    }
  }
  return std::exchange(changes_, {});
}

bool SessionRegistry::TakeDirty() { return std::exchange(dirty_, false); }

SessionSnapshot SessionRegistry::Snapshot() const {
  SessionSnapshot snapshot{
      .next_session_id = next_session_id_, .next_body_id = next_body_id_, .sessions = {}};
  for (const auto& [name, session] : sessions_) {
    KnownSession& known = snapshot.sessions.emplace_back(session.known);
    for (const auto& [person_name, person] : session.people) {
      known.people.push_back(person.known);
    }
  }
  return snapshot;
}

std::optional<SessionContents> SessionRegistry::Contents(std::string_view name) const {
  const auto session = sessions_.find(name);
  if (session == sessions_.end()) {
    return std::nullopt;
  }
  SessionContents contents{.state = StateOf(session->second), .entries = {}};
  for (const auto& [person_name, person] : session->second.people) {
    if (person.known.here) {
      contents.entries.push_back(EntryOf(session->second, person));
    }
  }
  return contents;
}

Result<SessionRegistry> SessionRegistry::Restore(const RegistryLimits& limits,
                                                 const SessionSnapshot& snapshot, Time now) {
  SessionRegistry registry(limits);
  registry.next_session_id_ = snapshot.next_session_id;
  registry.next_body_id_ = snapshot.next_body_id;
  registry.expired_at_ = now;
  registry.places_at_ = now;
  const auto corrupt = [](const std::string& why) { return Error{ErrorCode::kCorruptData, why}; };
  if (snapshot.sessions.size() > limits.max_sessions) {
    return corrupt(fmt::format("{} sessions, session.max_sessions is {}", snapshot.sessions.size(),
                               limits.max_sessions));
  }
  std::set<std::uint32_t> session_ids;
  std::set<std::uint32_t> body_ids;
  for (const KnownSession& known : snapshot.sessions) {
    if (const Status valid = ValidateSessionName(known.name); !valid) {
      return corrupt(valid.error().message);
    }
    if (registry.sessions_.contains(known.name) || known.session_id == 0 ||
        known.session_id >= snapshot.next_session_id ||
        !session_ids.insert(known.session_id).second) {
      return corrupt(fmt::format("session \"{}\" twice, or its id {} not below next_session_id",
                                 known.name, known.session_id));
    }
    Session& session = registry.sessions_[known.name];
    session.known = known;
    session.known.people.clear();
    registry.changes_.emplace_back(SessionOpened{});  // its numbers follow below
    std::set<std::uint32_t> slots;
    const std::size_t opened = registry.changes_.size() - 1;
    for (const KnownPerson& person : known.people) {
      if (const Status valid = ValidatePersonName(person.person); !valid) {
        return corrupt(valid.error().message);
      }
      if (session.people.contains(person.person) || person.body_id.value == 0 ||
          person.body_id.value >= snapshot.next_body_id ||
          !body_ids.insert(person.body_id.value).second) {
        return corrupt(fmt::format("\"{}\" in session \"{}\" twice, or its body {} given twice",
                                   person.person, known.name, person.body_id.value));
      }
      Person& restored = session.people[person.person];
      restored.known = person;
      if (!person.here) {
        ++registry.remembered_;
        continue;
      }
      if (Status fit = registry.CheckSensors(person.sensors); !fit) {
        return corrupt(fmt::format("\"{}\": {}", person.person, fit.error().message));
      }
      for (const roster::SensorAssignment& sensor : person.sensors) {
        if (!registry.wearers_.try_emplace(sensor.sensor_uid, Wearer{known.name, person.person})
                 .second) {
          return corrupt(fmt::format("sensor {:016x} worn by two", sensor.sensor_uid.value));
        }
      }
      if (person.coil_slot != 0 && !slots.insert(person.coil_slot).second) {
        return corrupt(fmt::format("coil slot {} given to two in session \"{}\"", person.coil_slot,
                                   known.name));
      }
      restored.alive = true;
      restored.seen_at = now;
      ++session.performers;
      ++registry.performers_;
      Count(session, person.client_uid, 1);
      registry.changes_.emplace_back(EntryChanged{registry.EntryOf(session, restored)});
    }
    if (session.performers > limits.max_members) {
      return corrupt(fmt::format("session \"{}\" has {} performers, session.max_members is {}",
                                 known.name, session.performers, limits.max_members));
    }
    registry.changes_[opened] = SessionOpened{registry.StateOf(session)};
  }
  registry.ForgetOldest();
  return registry;
}

}  // namespace limbcast::session
