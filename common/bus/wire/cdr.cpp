#include "common/bus/cdr.hpp"

#include <string>

#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"

namespace limbcast::bus {

template <typename T>
Status EncodeCdr(const T& value, std::vector<std::byte>& bytes) {
  thread_local typename Codec<T>::Wire wire;
  if (Status encoded = Codec<T>::Encode(value, wire); !encoded) {
    return encoded;
  }
  bytes.resize(Codec<T>::SerializedSize(wire));
  const std::span<char> out(reinterpret_cast<char*>(bytes.data()), bytes.size());
  Expects(Codec<T>::Serialize(wire, out) == bytes.size(), "a wire type that knows its size");
  return Ok();
}

template <typename T>
Status DecodeCdr(std::span<const std::byte> bytes, T& value) {
  thread_local typename Codec<T>::Wire wire;
  if (!Codec<T>::Deserialize({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, wire)) {
    return Error{ErrorCode::kCorruptData,
                 std::to_string(bytes.size()) + " bytes are no " + Codec<T>::kTypeName};
  }
  return Codec<T>::Decode(wire, value);
}

template <typename T>
std::string_view WireTypeName() {
  return Codec<T>::kTypeName;
}

// NOLINTBEGIN(bugprone-macro-parentheses): a type in parentheses is no type
#define LIMBCAST_CDR(Domain)                                                     \
  template Status EncodeCdr<Domain>(const Domain&, std::vector<std::byte>&);     \
  template Status DecodeCdr<Domain>(std::span<const std::byte>, Domain & value); \
  template std::string_view WireTypeName<Domain>()
// NOLINTEND(bugprone-macro-parentheses)

LIMBCAST_CDR(sensing::MargSample);
LIMBCAST_CDR(sensing::MargFrame);
LIMBCAST_CDR(sensing::FusedOrientation);
LIMBCAST_CDR(sensing::CoilBurst);
LIMBCAST_CDR(sensing::MarkerPosition);
LIMBCAST_CDR(sensing::PositionFix);
LIMBCAST_CDR(sensing::SensorInfo);
LIMBCAST_CDR(body::SegmentState);
LIMBCAST_CDR(body::SegmentFrame);
LIMBCAST_CDR(body::SegmentTruth);
LIMBCAST_CDR(body::BodyDefinition);
LIMBCAST_CDR(body::Skeleton);
LIMBCAST_CDR(body::JointAngleFrame);
LIMBCAST_CDR(roster::RosterEntry);
LIMBCAST_CDR(roster::SessionState);
LIMBCAST_CDR(roster::JoinRequest);
LIMBCAST_CDR(roster::JoinReply);
LIMBCAST_CDR(roster::Command);
LIMBCAST_CDR(roster::CommandReply);
LIMBCAST_CDR(ServiceHealth);

}  // namespace limbcast::bus
