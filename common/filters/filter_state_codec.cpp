#include "common/filters/filter_state_codec.hpp"

#include <algorithm>
#include <string>

#include "common/base/fnv1a.hpp"

namespace limbcast::filters {
namespace {

constexpr std::array<char, 8> kMagic = {'L', 'C', 'F', 'I', 'L', 'T', 'E', 'R'};

Error Refused(std::string_view filter, const std::string& why) {
  return Error{ErrorCode::kCorruptData,
               "saved state for filter " + std::string(filter) + " " + why};
}

}  // namespace

SavedStateHeader MakeStateHeader(std::string_view filter, std::uint32_t version,
                                 std::span<const std::byte> state) {
  SavedStateHeader header;
  header.magic = kMagic;
  std::copy_n(filter.begin(), std::min(filter.size(), header.filter.size()), header.filter.begin());
  header.version = version;
  header.size_bytes = static_cast<std::uint32_t>(state.size());
  header.checksum = Fnv1a(kFnv1aBasis, state);
  return header;
}

Status CheckStateHeader(std::string_view filter, std::uint32_t version,
                        std::size_t state_size_bytes, std::span<const std::byte> in) {
  const std::size_t expected = sizeof(SavedStateHeader) + state_size_bytes;
  if (in.size() != expected) {
    return Refused(filter, "has " + std::to_string(in.size()) + " bytes, expected " +
                               std::to_string(expected));
  }
  SavedStateHeader header;
  std::memcpy(&header, in.data(), sizeof header);
  const SavedStateHeader wanted =
      MakeStateHeader(filter, version, in.subspan(sizeof(SavedStateHeader)));
  if (header.magic != wanted.magic) {
    return Refused(filter, "does not begin with the magic of saved states");
  }
  if (header.filter != wanted.filter) {
    return Refused(filter, "is of another filter");
  }
  if (header.version != wanted.version || header.size_bytes != wanted.size_bytes) {
    return Refused(filter, "has version " + std::to_string(header.version) + ", expected " +
                               std::to_string(version));
  }
  if (header.checksum != wanted.checksum) {
    return Refused(filter, "is damaged: its checksum does not match");
  }
  return Ok();
}

}  // namespace limbcast::filters
