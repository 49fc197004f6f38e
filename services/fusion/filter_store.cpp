#include "services/fusion/filter_store.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "common/config/durable_file.hpp"

namespace limbcast::fusion {

namespace {

namespace fs = std::filesystem;

struct Header {
  std::array<char, 8> magic = {'L', 'C', 'F', 'U', 'S', 'I', 'O', 'N'};
  std::uint32_t version = 1;
  std::uint32_t count = 0;
  std::uint64_t settings = 0;
  std::int64_t saved_at_ns = 0;
};

struct EntryHeader {
  std::uint64_t sensor_uid = 0;
  std::uint64_t size_bytes = 0;
};

template <typename T>
std::optional<T> Cut(std::span<const std::byte>& from) {
  T value;
  if (from.size() < sizeof value) {
    return std::nullopt;
  }
  std::memcpy(&value, from.data(), sizeof value);
  from = from.subspan(sizeof value);
  return value;
}

// What follows the header, or nothing when it is not `count` whole entries.
std::optional<std::vector<std::pair<SensorUid, std::span<const std::byte>>>> Entries(
    std::span<const std::byte> bytes, std::uint32_t count) {
  std::vector<std::pair<SensorUid, std::span<const std::byte>>> entries;
  while (!bytes.empty()) {
    const auto header = Cut<EntryHeader>(bytes);
    if (!header || header->size_bytes > bytes.size()) {
      return std::nullopt;
    }
    entries.emplace_back(SensorUid{header->sensor_uid}, bytes.first(header->size_bytes));
    bytes = bytes.subspan(header->size_bytes);
  }
  return entries.size() == count ? std::optional(std::move(entries)) : std::nullopt;
}

}  // namespace

void FilterSnapshot::Clear() {
  entries.clear();
  count = 0;
  complete = false;
}

void FilterSnapshot::Add(SensorUid sensor_uid, const filters::OrientationFilter& filter) {
  const EntryHeader header{.sensor_uid = sensor_uid.value, .size_bytes = filter.state_size_bytes()};
  const std::size_t begin = entries.size();
  entries.resize(begin + sizeof header + header.size_bytes);
  std::memcpy(entries.data() + begin, &header, sizeof header);
  filter.SaveState(std::span(entries).subspan(begin + sizeof header));
  ++count;
}

void SavedFilters::Add(SensorUid sensor_uid, std::span<const std::byte> state) {
  const std::scoped_lock lock(mutex_);
  states_[sensor_uid].assign(state.begin(), state.end());
}

std::vector<std::byte> SavedFilters::Take(SensorUid sensor_uid) {
  const std::scoped_lock lock(mutex_);
  const auto found = states_.extract(sensor_uid);
  return found.empty() ? std::vector<std::byte>() : std::move(found.mapped());
}

std::size_t SavedFilters::size() const {
  const std::scoped_lock lock(mutex_);
  return states_.size();
}

FilterStore::FilterStore(fs::path folder, std::uint64_t settings)
    : folder_(std::move(folder)), settings_(settings) {}

Status FilterStore::Prepare() const {
  return keeps() ? config::PrepareFolder(folder_, "fusion.state_dir") : Ok();
}

// Not waited for until it is on the disk: what a restart of the service needs survives in the
// system's memory, and a file that a loss of power has cut is refused.
Status FilterStore::Save(std::span<const std::shared_ptr<FilterSnapshot>> snapshots,
                         Time now) const {
  if (!keeps()) {
    return Ok();
  }
  Header header;
  header.settings = settings_;
  header.saved_at_ns = now.time_since_epoch().count();
  for (const auto& snapshot : snapshots) {
    header.count += snapshot->count;
  }
  const fs::path temporary = path().string() + ".new";
  errno = 0;
  std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(&header), sizeof header);
  for (const auto& snapshot : snapshots) {
    file.write(reinterpret_cast<const char*>(snapshot->entries.data()),
               static_cast<std::streamsize>(snapshot->entries.size()));
  }
  file.close();
  std::error_code error(errno, std::generic_category());
  if (file) {
    error.clear();
    fs::rename(temporary, path(), error);
  }
  if (!file || error) {
    return Error{ErrorCode::kUnavailable,
                 fmt::format("write {}: {}", path().string(), error.message())};
  }
  return Ok();
}

Status FilterStore::Load(Time now, Duration max_age, SavedFilters& saved) const {
  std::error_code error;
  if (!keeps() || !fs::exists(path(), error)) {
    return Ok();
  }
  std::ifstream file(path(), std::ios::binary);
  const std::vector<char> content{std::istreambuf_iterator<char>(file), {}};
  std::span<const std::byte> bytes = std::as_bytes(std::span(content));
  const auto header = Cut<Header>(bytes);
  const bool known =
      header && header->magic == Header{}.magic && header->version == Header{}.version;
  const auto entries = known ? Entries(bytes, header->count) : std::nullopt;
  if (!entries) {
    fs::rename(path(), path().string() + ".refused", error);
    return Error{ErrorCode::kCorruptData,
                 fmt::format("{}: {}; it is kept as filters.state.refused", path().string(),
                             known ? "damaged or cut off" : "no filter states of this version")};
  }
  const Time saved_at{Duration(header->saved_at_ns)};
  if (header->settings != settings_ || now - saved_at > max_age) {
    return Ok();
  }
  for (const auto& [sensor_uid, state] : *entries) {
    saved.Add(sensor_uid, state);
  }
  return Ok();
}

}  // namespace limbcast::fusion
