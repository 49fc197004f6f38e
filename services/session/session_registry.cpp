#include "services/session/session_registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "common/base/expects.hpp"
#include "services/session/session_names.hpp"

namespace limbcast::session {
namespace {

using roster::CommandKind;
using roster::Role;

constexpr std::size_t kMaxMessage = 255;  // bound of the wire type
constexpr int kMissedRenewals = 3;

}  // namespace

std::string_view ToString(Refusal refusal) {
  constexpr std::array<std::string_view, kRefusalCount> kNames = {
      "bad_name",    "wrong_session", "exists",   "person_taken", "sensor_taken",
      "bad_sensors", "full",          "too_fast", "not_member",   "not_operator"};
  return kNames[static_cast<std::size_t>(refusal)];
}

SessionRegistry::SessionRegistry(const RegistryLimits& limits)
    : limits_(limits), places_(2.0 * limits.new_members_per_s) {
  Expects(Validate(limits).ok(), "valid RegistryLimits");
}

Error SessionRegistry::Refuse(Refusal refusal, ErrorCode code, std::string message) {
  ++counters_.refused[static_cast<std::size_t>(refusal)];
  message.resize(std::min(message.size(), kMaxMessage));
  return Error{code, std::move(message)};
}

SessionRegistry::Session* SessionRegistry::Find(std::string_view name) {
  const auto session = sessions_.find(name);
  return session == sessions_.end() ? nullptr : &session->second;
}

roster::SessionState SessionRegistry::StateOf(const Session& session) const {
  return {.session_id = session.known.session_id,
          .revision = session.known.revision,
          .name = session.known.name,
          .partition = session.known.name,
          .open = session.performers + session.watchers.size() < limits_.max_members,
          .performer_count = static_cast<std::uint32_t>(session.performers),
          .created_at = session.known.created_at};
}

roster::RosterEntry SessionRegistry::EntryOf(const Session& session, const Person& person) const {
  return {.body_id = person.known.body_id,
          .revision = person.known.revision,
          .session = session.known.name,
          .person = person.known.person,
          .sensors = person.known.sensors,
          .coil_slot = person.known.coil_slot,
          .coil_slots = person.known.coil_slot == 0 ? 0 : limits_.coil_slots,
          .coil_frame_us = person.known.coil_slot == 0 ? 0 : limits_.coil_frame_us};
}

Result<roster::SessionState> SessionRegistry::Create(std::string_view name, Time now) {
  if (const Status valid = ValidateSessionName(name); !valid) {
    return Refuse(Refusal::kBadName, valid.error().code, valid.error().message);
  }
  if (Find(name) != nullptr) {
    return Refuse(Refusal::kExists, ErrorCode::kInvalidArgument,
                  fmt::format("there is a session \"{}\" already", name));
  }
  if (sessions_.size() >= limits_.max_sessions) {
    return Refuse(Refusal::kFull, ErrorCode::kUnavailable,
                  fmt::format("this host has its {} sessions", limits_.max_sessions));
  }
  Session& session = sessions_[std::string(name)];
  session.known.session_id = next_session_id_++;
  session.known.revision = 1;
  session.known.name = name;
  session.known.created_at = now;
  changes_.emplace_back(SessionOpened{StateOf(session)});
  dirty_ = true;
  return StateOf(session);
}

SessionRegistry::Answer SessionRegistry::Join(std::string_view name,
                                              const roster::JoinRequest& request, Time now) {
  Answer answer;
  answer.reply.client_uid = request.client_uid;
  answer.reply.request_id = request.request_id;
  Status joined = Ok();
  Session* const session = Find(name);
  if (session == nullptr || request.session != name) {
    joined = Refuse(Refusal::kWrongSession, ErrorCode::kNotFound,
                    session == nullptr
                        ? fmt::format("there is no session \"{}\"", name)
                        : fmt::format("this is session \"{}\", not \"{}\"", name, request.session));
  } else if (const Status valid = ValidatePersonName(request.person); !valid) {
    joined = Refuse(Refusal::kBadName, valid.error().code, valid.error().message);
  } else {
    answer.reply.partition = session->known.name;
    joined = request.role == Role::kPerformer ? JoinPerformer(*session, request, now, answer)
                                              : JoinWatcher(*session, request, now, answer);
  }
  answer.reply.accepted = joined.ok();
  if (!joined) {
    answer.is_news = true;
    answer.reply.body_id = {};
    answer.reply.message = joined.error().message;
  }
  return answer;
}

Status SessionRegistry::JoinPerformer(Session& session, const roster::JoinRequest& request,
                                      Time now, Answer& answer) {
  const auto found = session.people.find(request.person);
  Person* const before = found == session.people.end() ? nullptr : &found->second;
  const bool here = before != nullptr && before->known.here;
  if (here && before->alive && before->known.client_uid != request.client_uid &&
      !IsRestart(*before, request, now)) {
    return Refuse(Refusal::kPersonTaken, ErrorCode::kUnavailable,
                  fmt::format("\"{}\" is in session \"{}\" through another client (body {})",
                              request.person, session.known.name, before->known.body_id.value));
  }
  const std::vector<roster::SensorAssignment>& sensors =
      request.sensors.empty() && before != nullptr ? before->known.sensors : request.sensors;
  if (Status fit = CheckSensors(sensors); !fit) {
    return fit;
  }
  if (Status free = CheckFree(session, request.person, sensors); !free) {
    return free;
  }
  if (before == nullptr && next_body_id_ == std::numeric_limits<std::uint32_t>::max()) {
    return Refuse(Refusal::kFull, ErrorCode::kUnavailable, "all body ids have been given away");
  }
  if (!here) {
    if (Status place = TakePlace(session, request.client_uid, now); !place) {
      return place;
    }
  }
  Person& person = here ? *before : session.people[request.person];
  Enter(session, person, request, now);
  answer.is_news = std::exchange(person.answered_request, request.request_id) != request.request_id;
  answer.reply.body_id = person.known.body_id;
  ForgetOldest();  // whose sensors it took may have been released
  return Ok();
}

// A client that was killed and started again has another uid, and brings the sensors that the
// person wears. Whoever is still there would have renewed by now.
bool SessionRegistry::IsRestart(const Person& before, const roster::JoinRequest& request,
                                Time now) {
  return request.sensors == before.known.sensors &&
         now - before.seen_at >= kMissedRenewals * roster::kRenewPeriod;
}

// Everything has been checked.
void SessionRegistry::Enter(Session& session, Person& person, const roster::JoinRequest& request,
                            Time now) {
  bool changed = false;
  if (!person.known.here) {
    if (person.known.body_id.value == 0) {
      person.known.person = request.person;
      person.known.body_id = {next_body_id_++};
    } else {
      --remembered_;
    }
    person.known.here = true;
    person.known.coil_slot =
        request.wants_coil_slot ? FreeSlot(session, person.known.coil_slot) : 0;
    person.answered_request = 0;
    ++performers_;
    ++session.performers;
    ++counters_.joined;
    Count(session, request.client_uid, 1);
    Changed(session);
    Wear(session, person, request.sensors.empty() ? person.known.sensors : request.sensors, now);
    changed = true;
  } else {
    ++counters_.renewed;
    if (person.known.client_uid != request.client_uid) {  // it vanished; this client carries it on
      Count(session, person.known.client_uid, -1);
      Count(session, request.client_uid, 1);
      person.answered_request = 0;
      dirty_ = true;
      if (request.wants_coil_slot != (person.known.coil_slot != 0)) {
        person.known.coil_slot = request.wants_coil_slot ? FreeSlot(session, 0) : 0;
        changed = true;
      }
    }
  }
  if (!request.sensors.empty() && person.known.sensors != request.sensors) {
    Wear(session, person, request.sensors, now);
    changed = true;
  }
  person.wants_coil_slot = request.wants_coil_slot;
  person.known.client_uid = request.client_uid;
  person.alive = true;
  person.seen_at = now;
  if (changed) {
    ++person.known.revision;
    changes_.emplace_back(EntryChanged{EntryOf(session, person)});
    dirty_ = true;
  }
}

Status SessionRegistry::JoinWatcher(Session& session, const roster::JoinRequest& request, Time now,
                                    Answer& answer) {
  const WatcherKey key{request.client_uid, request.role, request.person};
  auto watcher = session.watchers.find(key);
  if (watcher == session.watchers.end()) {
    if (Status place = TakePlace(session, request.client_uid, now); !place) {
      return place;
    }
    watcher = session.watchers.emplace(key, Watcher{}).first;
    Count(session, request.client_uid, 1);
    ++watchers_;
    ++counters_.joined;
  } else {
    ++counters_.renewed;
  }
  watcher->second.seen_at = now;
  answer.is_news =
      std::exchange(watcher->second.answered_request, request.request_id) != request.request_id;
  return Ok();
}

Status SessionRegistry::CheckSensors(const std::vector<roster::SensorAssignment>& sensors) {
  const auto refuse = [this](const std::string& why) {
    return Refuse(Refusal::kBadSensors, ErrorCode::kInvalidArgument, why);
  };
  if (sensors.empty()) {
    return refuse("a performer must wear at least one sensor");
  }
  std::array<bool, body::kSegmentCount> taken{};
  std::vector<SensorUid> uids;
  for (const roster::SensorAssignment& sensor : sensors) {
    const std::size_t segment = body::Index(sensor.segment);
    if (sensor.sensor_uid.value == 0 || segment >= body::kSegmentCount) {
      return refuse("a sensor must have a uid that is not 0, and sit on a segment");
    }
    if (std::exchange(taken[segment], true)) {
      return refuse(fmt::format("two sensors on segment {}", body::ToString(sensor.segment)));
    }
    uids.push_back(sensor.sensor_uid);
  }
  std::sort(uids.begin(), uids.end());
  const auto twice = std::adjacent_find(uids.begin(), uids.end());
  return twice == uids.end() ? Ok()
                             : refuse(fmt::format("sensor {:016x} on two segments", twice->value));
}

// Whoever is alive keeps its sensors; who vanished loses them in Wear.
Status SessionRegistry::CheckFree(const Session& session, std::string_view person,
                                  const std::vector<roster::SensorAssignment>& sensors) {
  for (const roster::SensorAssignment& sensor : sensors) {
    const auto wearer = wearers_.find(sensor.sensor_uid);
    if (wearer == wearers_.end() ||
        (wearer->second.session == session.known.name && wearer->second.person == person)) {
      continue;
    }
    const auto& [its_session, its_person] = wearer->second;
    if (sessions_.at(its_session).people.at(its_person).alive) {
      return Refuse(Refusal::kSensorTaken, ErrorCode::kUnavailable,
                    fmt::format("sensor {:016x} is worn by \"{}\" in session \"{}\"",
                                sensor.sensor_uid.value, its_person, its_session));
    }
  }
  return Ok();
}

Status SessionRegistry::TakePlace(Session& session, std::uint64_t client_uid, Time now) {
  if (session.performers + session.watchers.size() >= limits_.max_members) {
    return Refuse(
        Refusal::kFull, ErrorCode::kUnavailable,
        fmt::format("session \"{}\" has its {} members", session.known.name, limits_.max_members));
  }
  const auto own = session.members_of_client.find(client_uid);
  if (own != session.members_of_client.end() && own->second >= limits_.max_members_of_client) {
    return Refuse(Refusal::kFull, ErrorCode::kUnavailable,
                  fmt::format("one client may join {} times", limits_.max_members_of_client));
  }
  const double passed_s = std::max(0.0, ToSeconds(now - std::exchange(places_at_, now)));
  places_ =
      std::min(places_ + passed_s * limits_.new_members_per_s, 2.0 * limits_.new_members_per_s);
  if (places_ < 1.0) {
    return Refuse(
        Refusal::kTooFast, ErrorCode::kUnavailable,
        fmt::format("at most {} new members a second; try again", limits_.new_members_per_s));
  }
  places_ -= 1.0;
  return Ok();
}

Status SessionRegistry::Do(std::string_view name, const roster::Command& command, Time now) {
  Session* const session = Find(name);
  if (session == nullptr) {
    return Refuse(Refusal::kWrongSession, ErrorCode::kNotFound,
                  fmt::format("there is no session \"{}\"", name));
  }
  if (command.kind == CommandKind::kLeaveSession) {
    return Leave(*session, command, now);
  }
  if (Status allowed = CheckOperator(*session, command.client_uid); !allowed) {
    return allowed;
  }
  if (command.kind == CommandKind::kCloseSession) {
    Close(*session);
    return Ok();
  }
  Expects(command.kind == CommandKind::kReleasePerson, "a command for the session host");
  const auto person = session->people.find(command.text);
  if (person == session->people.end() || !person->second.known.here) {
    return Refuse(Refusal::kNotMember, ErrorCode::kNotFound,
                  fmt::format("\"{}\" is not in session \"{}\"", command.text, name));
  }
  Release(*session, person->second, now);
  ForgetOldest();
  return Ok();
}

Status SessionRegistry::CheckOperator(const Session& session, std::uint64_t client_uid) {
  const auto first = session.watchers.lower_bound({client_uid, Role::kOperator, {}});
  if (first != session.watchers.end() && std::get<0>(first->first) == client_uid &&
      std::get<1>(first->first) == Role::kOperator) {
    return Ok();
  }
  return Refuse(Refusal::kNotOperator, ErrorCode::kUnavailable,
                fmt::format("only an operator of session \"{}\" may do that", session.known.name));
}

Status SessionRegistry::Leave(Session& session, const roster::Command& command, Time now) {
  std::size_t left = std::erase_if(session.watchers, [&](const auto& watcher) {
    const auto& [client, role, person] = watcher.first;
    return client == command.client_uid && (command.text.empty() || command.text == person);
  });
  watchers_ -= left;
  Count(session, command.client_uid, -static_cast<int>(left));
  for (auto& [name, person] : session.people) {
    if (person.known.here && person.known.client_uid == command.client_uid &&
        (command.text.empty() || command.text == name)) {
      Release(session, person, now);
      ++left;
    }
  }
  if (left == 0) {
    return Refuse(Refusal::kNotMember, ErrorCode::kNotFound,
                  fmt::format("this client is not in session \"{}\"", session.known.name));
  }
  counters_.left += left;
  ForgetOldest();
  return Ok();
}

void SessionRegistry::Expire(Time now) {
  // Nobody could be heard while the host was away.
  const Duration passed = now - expired_at_.value_or(now);
  expired_at_ = now;
  const Duration away =
      passed < Duration::zero() || passed > limits_.lease / 2 ? passed : Duration::zero();
  for (auto& [name, session] : sessions_) {
    for (auto& [person_name, person] : session.people) {
      if (!person.known.here) {
        continue;
      }
      person.seen_at += away;
      if (person.alive && now - person.seen_at > limits_.lease) {
        person.alive = false;
        ++counters_.vanished;
      }
      if (!person.alive && now - person.seen_at > limits_.lease + limits_.grace) {
        Release(session, person, now);
        ++counters_.released;
      }
    }
    for (auto watcher = session.watchers.begin(); watcher != session.watchers.end();) {
      watcher->second.seen_at += away;
      if (now - watcher->second.seen_at <= limits_.lease) {
        ++watcher;
        continue;
      }
      Count(session, std::get<0>(watcher->first), -1);
      --watchers_;
      ++counters_.vanished;
      watcher = session.watchers.erase(watcher);
    }
  }
  ForgetOldest();
}

}  // namespace limbcast::session
