#include "services/session/session_store.hpp"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <iterator>
#include <limits>
#include <string_view>
#include <system_error>
#include <vector>

#include "common/config/config_file.hpp"
#include "common/config/durable_file.hpp"
#include "common/config/toml_text.hpp"

namespace limbcast::session {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 1;
constexpr auto kAnyNumber = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxName = 64;

Error Corrupt(std::string message) { return Error{ErrorCode::kCorruptData, std::move(message)}; }

Time ReadTime(const config::Section& section, std::string_view key) {
  return TimeFromNanoseconds(section.Read(key, std::int64_t{0},
                                          std::numeric_limits<std::int64_t>::min(),
                                          std::numeric_limits<std::int64_t>::max()));
}

// "pelvis 00000000000000a1"
std::vector<roster::SensorAssignment> ReadSensors(const config::Section& section) {
  std::vector<roster::SensorAssignment> sensors;
  for (const std::string& text : section.Read("sensors", std::vector<std::string>())) {
    const std::size_t space = text.find(' ');
    const auto segment = body::ParseSegment(text.substr(0, space));
    roster::SensorAssignment sensor;
    const char* const end = text.data() + text.size();
    const bool whole =
        segment && space != std::string::npos && text.size() == space + 17 &&
        std::from_chars(text.data() + space + 1, end, sensor.sensor_uid.value, 16).ptr == end;
    if (!whole) {
      section.Fail("sensors", fmt::format("must be segments and uids, has \"{}\"", text));
      return {};
    }
    sensor.segment = *segment;
    sensors.push_back(sensor);
  }
  return sensors;
}

KnownPerson ReadPerson(const config::Section& section) {
  KnownPerson person;
  person.person = section.Read("name", "", kMaxName);
  person.body_id = {section.Read("body_id", 0U, 0U, kAnyNumber)};
  person.client_uid = config::ReadHex64(section, "client_uid");
  person.revision = section.Read("revision", 0U, 0U, kAnyNumber);
  person.coil_slot = section.Read("coil_slot", 0U, 0U, kAnyNumber);
  person.here = section.Read("here", false);
  person.left_at = ReadTime(section, "left_at_ns");
  person.sensors = ReadSensors(section);
  return person;
}

Result<std::string> ReadAll(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Error{ErrorCode::kNotFound, fmt::format("{}: cannot be opened", path.string())};
  }
  return std::string(std::istreambuf_iterator<char>(file), {});
}

}  // namespace

std::string ToToml(const SessionSnapshot& snapshot) {
  std::string text = fmt::format(
      "# Sessions and people, written by limbcast-session.\n"
      "version = {}\nnext_session_id = {}\nnext_body_id = {}\n",
      kVersion, snapshot.next_session_id, snapshot.next_body_id);
  std::size_t people = 0;
  for (const KnownSession& session : snapshot.sessions) {
    text += fmt::format("\n[[session]]\nname = {}\nid = {}\nrevision = {}\ncreated_at_ns = {}\n",
                        config::Quoted(session.name), session.session_id, session.revision,
                        ToNanoseconds(session.created_at));
    for (const KnownPerson& person : session.people) {
      ++people;
      text += fmt::format(
          "\n[[session.person]]\nname = {}\nbody_id = {}\nclient_uid = \"{:016x}\"\n"
          "revision = {}\ncoil_slot = {}\nhere = {}\nleft_at_ns = {}\nsensors = [",
          config::Quoted(person.person), person.body_id.value, person.client_uid, person.revision,
          person.coil_slot, person.here, ToNanoseconds(person.left_at));
      for (const roster::SensorAssignment& sensor : person.sensors) {
        text += fmt::format("\"{} {:016x}\", ", body::ToString(sensor.segment),
                            sensor.sensor_uid.value);
      }
      text += "]\n";
    }
  }
  // Read back to know that nothing is cut off.
  return text +
         fmt::format("\n[end]\nsessions = {}\npeople = {}\n", snapshot.sessions.size(), people);
}

Result<SessionSnapshot> FromToml(const std::string& text, const std::string& name) {
  const auto file = config::ConfigFile::Parse(text, name);
  if (!file) {
    return Corrupt(file.error().message);
  }
  const config::Section root = file->Root();
  if (!root.Has("end")) {
    return Corrupt(name + ": cut off, [end] is missing");
  }
  (void)root.Read("version", 0, kVersion, kVersion);
  SessionSnapshot snapshot;
  snapshot.next_session_id = root.Read("next_session_id", 1U, 1U, kAnyNumber);
  snapshot.next_body_id = root.Read("next_body_id", 1U, 1U, kAnyNumber);
  std::size_t people = 0;
  for (const config::Section& section : root.GetAll("session")) {
    KnownSession& session = snapshot.sessions.emplace_back();
    session.name = section.Read("name", "", kMaxName);
    session.session_id = section.Read("id", 0U, 0U, kAnyNumber);
    session.revision = section.Read("revision", 0U, 0U, kAnyNumber);
    session.created_at = ReadTime(section, "created_at_ns");
    for (const config::Section& person : section.GetAll("person")) {
      session.people.push_back(ReadPerson(person));
      ++people;
    }
  }
  const config::Section end = root.Get("end");
  if (end.Read("sessions", std::size_t{0}, 0U, kAnyNumber) != snapshot.sessions.size() ||
      end.Read("people", std::size_t{0}, 0U, kAnyNumber) != people) {
    end.Fail("people", fmt::format("and sessions must be {} and {}, the numbers in the file",
                                   people, snapshot.sessions.size()));
  }
  if (const Status read = file->Finish(); !read) {
    return Corrupt(read.error().message);
  }
  return snapshot;
}

Status SessionStore::Prepare() const {
  return folder_.empty() ? Ok() : config::PrepareFolder(folder_, "session.state_dir");
}

Status SessionStore::Save(const SessionSnapshot& snapshot) {
  if (folder_.empty()) {
    return Ok();
  }
  Status saved = config::ReplaceDurably(path(), ToToml(snapshot),
                                        path().string() + (refused_ ? ".refused" : ".old"));
  refused_ = refused_ && !saved;
  return saved;
}

Result<SessionStore::Loaded> SessionStore::Load() {
  std::string warning;
  bool any = false;
  if (folder_.empty()) {
    return Loaded{};
  }
  std::error_code error;
  for (const fs::path& candidate : {path(), fs::path(path().string() + ".old")}) {
    if (!fs::exists(candidate, error)) {
      continue;
    }
    any = true;
    const Result<std::string> text = ReadAll(candidate);
    Result<SessionSnapshot> snapshot =
        text ? FromToml(*text, candidate.string()) : Result<SessionSnapshot>(text.error());
    if (snapshot) {
      return Loaded{std::move(*snapshot), warning};
    }
    refused_ = refused_ || candidate == path();
    warning += (warning.empty() ? "" : "; ") + snapshot.error().message;
  }
  return any ? Result<Loaded>(Corrupt(warning)) : Result<Loaded>(Loaded{});
}

}  // namespace limbcast::session
