#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/base/result.hpp"
#include "common/bus/topics.hpp"
#include "common/bus/wire/instance_key.hpp"

namespace eprosima::fastcdr {
class Cdr;
}
namespace limbcast::wire {
class MargSample;
class MargFrame;
class FusedOrientation;
class CoilBurst;
class MarkerPosition;
class PositionFix;
class SensorInfo;
class SegmentState;
class SegmentFrame;
class SegmentTruth;
class BodyDefinition;
class Skeleton;
class JointAngleFrame;
class RosterEntry;
class SessionState;
class JoinRequest;
class JoinReply;
class Command;
class CommandReply;
class ServiceHealth;
}  // namespace limbcast::wire

namespace limbcast::bus {

/// The generated type that carries a domain type, and the name DDS knows it by.
template <typename T>
struct WireType;

#define LIMBCAST_WIRE_TYPE(Domain, Name, has_text)                                                \
  template <>                                                                                     \
  struct WireType<Domain> { /* NOLINT(bugprone-macro-parentheses): a type and a template argument \
                             */                                                                   \
    using Type = wire::Name;                                                                      \
    static constexpr const char* kName = "limbcast::wire::" #Name;                                \
    static constexpr bool kHasText = has_text;                                                    \
  }
LIMBCAST_WIRE_TYPE(sensing::MargSample, MargSample, false);
LIMBCAST_WIRE_TYPE(sensing::MargFrame, MargFrame, false);
LIMBCAST_WIRE_TYPE(sensing::FusedOrientation, FusedOrientation, false);
LIMBCAST_WIRE_TYPE(sensing::CoilBurst, CoilBurst, false);
LIMBCAST_WIRE_TYPE(sensing::MarkerPosition, MarkerPosition, false);
LIMBCAST_WIRE_TYPE(sensing::PositionFix, PositionFix, false);
LIMBCAST_WIRE_TYPE(sensing::SensorInfo, SensorInfo, true);
LIMBCAST_WIRE_TYPE(body::SegmentState, SegmentState, true);
LIMBCAST_WIRE_TYPE(body::SegmentFrame, SegmentFrame, true);
LIMBCAST_WIRE_TYPE(body::SegmentTruth, SegmentTruth, false);
LIMBCAST_WIRE_TYPE(body::BodyDefinition, BodyDefinition, true);
LIMBCAST_WIRE_TYPE(body::Skeleton, Skeleton, false);
LIMBCAST_WIRE_TYPE(body::JointAngleFrame, JointAngleFrame, false);
LIMBCAST_WIRE_TYPE(roster::RosterEntry, RosterEntry, true);
LIMBCAST_WIRE_TYPE(roster::SessionState, SessionState, true);
LIMBCAST_WIRE_TYPE(roster::JoinRequest, JoinRequest, true);
LIMBCAST_WIRE_TYPE(roster::JoinReply, JoinReply, true);
LIMBCAST_WIRE_TYPE(roster::Command, Command, true);
LIMBCAST_WIRE_TYPE(roster::CommandReply, CommandReply, true);
LIMBCAST_WIRE_TYPE(ServiceHealth, ServiceHealth, true);
#undef LIMBCAST_WIRE_TYPE

using KeyHash = std::array<std::uint8_t, 16>;

/// No key-only CDR is longer: header, 16 bytes of key, padding.
inline constexpr std::size_t kMaxKeyCdr_bytes = 24;

/// Copies between a domain value and its wire type: fields and nothing else, no unit, frame or
/// default is decided here. Stateless, thread-safe. Wire objects are made once and reused: nothing
/// here allocates once their sequences have grown. The generated types are complete after including
/// wire/wire_types.hpp.
template <typename T>
struct Codec {
  using Wire = typename WireType<T>::Type;
  static constexpr const char* kTypeName = WireType<T>::kName;

  /// Fails with kInvalidArgument, naming the field, when a text or list is longer than the wire
  /// type allows (or a text holds a NUL).
  [[nodiscard]] static Status CheckBounds(const T& value);
  /// As CheckBounds; `wire` means nothing after a failure.
  [[nodiscard]] static Status Encode(const T& value, Wire& wire);
  /// Fails with kCorruptData, naming the field, on a number that is no enumerator or a list longer
  /// than allowed; `value` means nothing then.
  [[nodiscard]] static Status Decode(const Wire& wire, T& value);

  [[nodiscard]] static InstanceKey Key(const T& value);
  /// Copy the key fields and leave the rest alone.
  static void EncodeKey(const T& value, Wire& wire);
  [[nodiscard]] static Status DecodeKey(const Wire& wire, T& value);
  static void CopyKey(const Wire& from, Wire& to);
  /// Reads what the generated serializeKey writes. Throws Fast CDR's exceptions.
  static void KeyDeserialize(eprosima::fastcdr::Cdr& cdr, Wire& wire);

  // CDR, each with its 4-byte encapsulation header (XCDR1, the host's byte order; both orders are
  // read).

  /// Exact size, without padding at the end.
  [[nodiscard]] static std::size_t SerializedSize(const Wire& wire);
  /// How many bytes of `out` are used; 0 when it is too small.
  [[nodiscard]] static std::size_t Serialize(const Wire& wire, std::span<char> out);
  /// False when the bytes are not one whole Wire: truncated, trailing bytes, a boolean that is
  /// none, a text longer than its bound. Never throws; `wire` means nothing after a failure. Enum
  /// numbers and list lengths are Decode's affair.
  [[nodiscard]] static bool Deserialize(std::span<const char> bytes, Wire& wire);
  /// The same for the key fields alone, as dispose messages carry them: at most kMaxKeyCdr_bytes,
  /// padding included.
  [[nodiscard]] static std::size_t SerializeKey(const Wire& wire, std::span<char> out);
  [[nodiscard]] static bool DeserializeKey(std::span<const char> bytes, Wire& wire);
  /// Only the key fields of a whole sample (they come first in every type); false when it is too
  /// short for them.
  [[nodiscard]] static bool DeserializeLeadingKey(std::span<const char> bytes, Wire& wire);

  /// The key fields as DDS hashes them: big-endian CDR without header, padded with zeros (no key is
  /// longer than 16 bytes, so it is never an MD5).
  [[nodiscard]] static KeyHash HashKey(const Wire& wire);
  static void FromKeyHash(const KeyHash& hash, Wire& wire);
};

#define LIMBCAST_EXTERN_CODEC(Domain) extern template struct Codec<Domain>
LIMBCAST_EXTERN_CODEC(sensing::MargSample);
LIMBCAST_EXTERN_CODEC(sensing::MargFrame);
LIMBCAST_EXTERN_CODEC(sensing::FusedOrientation);
LIMBCAST_EXTERN_CODEC(sensing::CoilBurst);
LIMBCAST_EXTERN_CODEC(sensing::MarkerPosition);
LIMBCAST_EXTERN_CODEC(sensing::PositionFix);
LIMBCAST_EXTERN_CODEC(sensing::SensorInfo);
LIMBCAST_EXTERN_CODEC(body::SegmentState);
LIMBCAST_EXTERN_CODEC(body::SegmentFrame);
LIMBCAST_EXTERN_CODEC(body::SegmentTruth);
LIMBCAST_EXTERN_CODEC(body::BodyDefinition);
LIMBCAST_EXTERN_CODEC(body::Skeleton);
LIMBCAST_EXTERN_CODEC(body::JointAngleFrame);
LIMBCAST_EXTERN_CODEC(roster::RosterEntry);
LIMBCAST_EXTERN_CODEC(roster::SessionState);
LIMBCAST_EXTERN_CODEC(roster::JoinRequest);
LIMBCAST_EXTERN_CODEC(roster::JoinReply);
LIMBCAST_EXTERN_CODEC(roster::Command);
LIMBCAST_EXTERN_CODEC(roster::CommandReply);
LIMBCAST_EXTERN_CODEC(ServiceHealth);
#undef LIMBCAST_EXTERN_CODEC

}  // namespace limbcast::bus
