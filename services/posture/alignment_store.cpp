#include "services/posture/alignment_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

#include "common/body/default_body.hpp"
#include "common/config/config_file.hpp"
#include "common/config/durable_file.hpp"
#include "common/config/toml_text.hpp"

namespace limbcast::posture {
namespace {

namespace fs = std::filesystem;

constexpr int kVersion = 1;
constexpr double kMaxOffset_m = 2.0;

std::string Vector(const Eigen::Vector3d& v) {
  return fmt::format("[{}, {}, {}]", v.x(), v.y(), v.z());
}

std::string Write(const body::BodyDefinition& definition) {
  std::string text = fmt::format(
      "# Alignment and dimensions of one body, written by limbcast-posture. q is w x y z.\n"
      "version = {}\nbody_id = {}\nrevision = {}\n",
      kVersion, definition.body_id.value, definition.revision);
  for (const body::SegmentDefinition& segment : definition.segments) {
    const Eigen::Quaterniond& q = segment.q_sensor_segment;
    text += fmt::format(
        "\n[{}]\nsensor_uid = \"{:016x}\"\naligned = {}\nq_sensor_segment = [{}, {}, {}, {}]\n"
        "heading_correction_rad = {}\np_parent_segment_m = {}\np_segment_end_m = {}\n",
        body::ToString(segment.segment), segment.sensor_uid.value, segment.aligned, q.w(), q.x(),
        q.y(), q.z(), segment.heading_correction_rad, Vector(segment.p_parent_segment_m),
        Vector(segment.p_segment_end_m));
    text += segment.alignment_quality < 1.0F
                ? fmt::format("alignment_quality = {}\n", segment.alignment_quality)
                : "";
    text += segment.length_measured ? "length_measured = true\n" : "";
  }
  // Read back to know that nothing is cut off.
  return text + fmt::format("\n[end]\nsegments = {}\n", definition.segments.size());
}

Eigen::Vector3d ReadVector(const config::Section& section, const char* key) {
  const std::vector<double> v =
      section.ReadNumbers(key, {0.0, 0.0, 0.0}, -kMaxOffset_m, kMaxOffset_m, 3);
  return v.size() == 3 ? Eigen::Vector3d(v[0], v[1], v[2]) : Eigen::Vector3d::Zero();
}

void ReadSegment(const config::Section& section, body::SegmentDefinition& segment) {
  segment.sensor_uid.value = config::ReadHex64(section, "sensor_uid");
  segment.aligned = section.Read("aligned", false);
  const std::vector<double> q = section.ReadNumbers("q_sensor_segment", {1, 0, 0, 0}, -1.0, 1.0, 4);
  if (q.size() == 4) {
    segment.q_sensor_segment = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  }
  if (!(std::abs(segment.q_sensor_segment.norm() - 1.0) < 1e-6)) {
    section.Fail("q_sensor_segment", "must be of unit length");
  }
  segment.heading_correction_rad = section.Read("heading_correction_rad", 0.0, -3.15, 3.15);
  segment.p_parent_segment_m = ReadVector(section, "p_parent_segment_m");
  segment.p_segment_end_m = ReadVector(section, "p_segment_end_m");
  segment.length_measured = section.Read("length_measured", false);
  segment.alignment_quality = static_cast<float>(section.Read("alignment_quality", 1.0, 0.0, 1.0));
}

/// Puts what `path` holds over a definition; `any_body`: whoever's it is.
Status ReadDefinition(const fs::path& path, bool any_body, body::BodyDefinition& definition) {
  const auto file = config::ConfigFile::Load(path);
  if (!file) {
    return Error{ErrorCode::kCorruptData, file.error().message};
  }
  const config::Section root = file->Root();
  if (!root.Has("end")) {
    return Error{ErrorCode::kCorruptData,
                 fmt::format("{}: cut off, [end] is missing", path.string())};
  }
  (void)root.Read("version", 0, kVersion, kVersion);
  if (root.Read("body_id", definition.body_id.value, 0U, UINT32_MAX) != definition.body_id.value &&
      !any_body) {
    root.Fail("body_id", fmt::format("must be {}", definition.body_id.value));
  }
  body::BodyDefinition loaded = definition;
  loaded.revision = std::max(loaded.revision, root.Read("revision", 0U, 0U, UINT32_MAX - 1U));
  std::size_t count = 0;
  for (const body::Segment segment : body::AllSegments()) {
    const std::string name(body::ToString(segment));
    if (!root.Has(name)) {
      continue;
    }
    ++count;
    body::SegmentDefinition read;
    ReadSegment(root.Get(name), read);
    if (body::SegmentDefinition* const into = body::Find(loaded, segment)) {
      into->sensor_uid = read.sensor_uid;
      body::TakeAlignment(read, *into);
      body::TakeDimensions(read, *into);
    }
  }
  const config::Section end = root.Get("end");
  if (end.Read("segments", std::size_t{0}, 0U, 32U) != count) {
    end.Fail("segments", fmt::format("must be {}, the number of segments in the file", count));
  }
  if (const Status read = file->Finish(); !read) {
    return Error{ErrorCode::kCorruptData, read.error().message};
  }
  if (const Status valid = body::Validate(loaded); !valid) {
    return Error{ErrorCode::kCorruptData,
                 fmt::format("{}: {}", path.string(), valid.error().message)};
  }
  definition = std::move(loaded);
  return Ok();
}

Status CheckName(std::string_view name) {
  constexpr std::size_t kMost = AlignmentStore::kMaxProfileName;
  if (name.empty() || name.size() > kMost) {
    return Error{
        ErrorCode::kInvalidArgument,
        fmt::format("a profile's name must have 1 to {} characters, has {}", kMost, name.size())};
  }
  return Ok();
}

}  // namespace

fs::path AlignmentStore::PathOf(BodyId body_id) const {
  return folder_ / fmt::format("body_{}.toml", body_id.value);
}

Status AlignmentStore::Prepare() const {
  return folder_.empty() ? Ok() : config::PrepareFolder(folder_, "posture.state_dir");
}

Status AlignmentStore::Save(const body::BodyDefinition& definition) const {
  return folder_.empty() ? Ok() : Replace(PathOf(definition.body_id), definition);
}

Status AlignmentStore::Replace(const fs::path& path, const body::BodyDefinition& definition) const {
  std::error_code error;
  body::BodyDefinition scratch = definition;
  const bool spoiled = fs::exists(path, error) && !ReadDefinition(path, true, scratch);
  const std::string refused = spoiled ? path.string() + ".refused" : "";
  return config::ReplaceDurably(path, Write(definition), refused);
}

Result<bool> AlignmentStore::Load(body::BodyDefinition& definition) const {
  const fs::path path = PathOf(definition.body_id);
  std::error_code error;
  if (folder_.empty() || !fs::exists(path, error)) {
    return false;
  }
  if (const Status read = ReadDefinition(path, false, definition); !read) {
    return read.error();
  }
  return true;
}

fs::path AlignmentStore::ProfilePathOf(std::string_view name) const {
  std::string file = "profile_";
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '-' || c == '_';
    file += plain ? c : '_';
  }
  return folder_ / (file + ".toml");
}

bool AlignmentStore::HasProfile(std::string_view name) const {
  std::error_code error;
  return !folder_.empty() && CheckName(name).ok() && fs::exists(ProfilePathOf(name), error);
}

Status AlignmentStore::SaveProfile(std::string_view name,
                                   const body::BodyDefinition& definition) const {
  if (Status named = CheckName(name); !named) {
    return named;
  }
  if (folder_.empty()) {
    return Error{ErrorCode::kUnavailable, "posture.state_dir is empty: nothing is kept"};
  }
  return Replace(ProfilePathOf(name), definition);
}

Result<std::size_t> AlignmentStore::LoadProfile(std::string_view name,
                                                body::BodyDefinition& definition) const {
  if (const Status named = CheckName(name); !named) {
    return named.error();
  }
  if (!HasProfile(name)) {
    return Error{ErrorCode::kNotFound, fmt::format("no profile \"{}\"", name)};
  }
  body::BodyDefinition loaded = definition;
  if (const Status read = ReadDefinition(ProfilePathOf(name), true, loaded); !read) {
    return read.error();
  }
  std::size_t aligned = 0;
  for (std::size_t row = 0; row < definition.segments.size(); ++row) {
    body::SegmentDefinition& into = definition.segments[row];
    const body::SegmentDefinition& from = loaded.segments[row];
    body::TakeDimensions(from, into);
    if (from.aligned && from.sensor_uid == into.sensor_uid) {
      body::TakeAlignment(from, into);
      ++aligned;
    }
  }
  return aligned;
}

}  // namespace limbcast::posture
