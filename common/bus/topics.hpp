#pragma once

#include <cstdint>
#include <string_view>
#include <tuple>

#include "common/base/health.hpp"
#include "common/body/body_definition.hpp"
#include "common/body/joint_angle_frame.hpp"
#include "common/body/segment_frame.hpp"
#include "common/body/segment_state.hpp"
#include "common/body/segment_truth.hpp"
#include "common/body/skeleton.hpp"
#include "common/bus/qos.hpp"
#include "common/roster/command.hpp"
#include "common/roster/roster.hpp"
#include "common/roster/session.hpp"
#include "common/sensing/coil_burst.hpp"
#include "common/sensing/fused_orientation.hpp"
#include "common/sensing/marg_frame.hpp"
#include "common/sensing/marg_sample.hpp"
#include "common/sensing/position_samples.hpp"
#include "common/sensing/sensor_info.hpp"

namespace limbcast::bus {

/// The topic of a domain type: its name on the wire and its QoS. Two topics never carry the same
/// type.
template <typename T>
struct Topic;

#define LIMBCAST_TOPIC(Type, name, profile, exclusive)                                          \
  template <>                                                                                   \
  struct Topic<Type> { /* NOLINT(bugprone-macro-parentheses): a type and a template argument */ \
    static constexpr std::string_view kName = "limbcast/v1/" name;                              \
    static constexpr std::string_view kShortName = name;                                        \
    static constexpr QosProfile kProfile = profile;                                             \
    static constexpr bool kExclusiveOwnership = exclusive;                                      \
  }

LIMBCAST_TOPIC(sensing::MargSample, "marg", QosProfile::kStream, false);
LIMBCAST_TOPIC(sensing::MargFrame, "marg_frame", QosProfile::kFrame, false);
LIMBCAST_TOPIC(sensing::FusedOrientation, "orientation", QosProfile::kStream, false);
LIMBCAST_TOPIC(sensing::CoilBurst, "coil_burst", QosProfile::kStream, false);
LIMBCAST_TOPIC(sensing::MarkerPosition, "marker", QosProfile::kStream, false);
LIMBCAST_TOPIC(sensing::PositionFix, "position_fix", QosProfile::kStream, false);
LIMBCAST_TOPIC(sensing::SensorInfo, "sensor_info", QosProfile::kState, false);
LIMBCAST_TOPIC(body::SegmentState, "segment_state", QosProfile::kStream, true);
LIMBCAST_TOPIC(body::SegmentFrame, "segment_frame", QosProfile::kFrame, true);
LIMBCAST_TOPIC(body::SegmentTruth, "truth", QosProfile::kStream, false);
LIMBCAST_TOPIC(body::BodyDefinition, "body_definition", QosProfile::kState, false);
LIMBCAST_TOPIC(body::Skeleton, "skeleton", QosProfile::kFrame, true);
LIMBCAST_TOPIC(body::JointAngleFrame, "joint_angles", QosProfile::kFrame, true);
LIMBCAST_TOPIC(roster::RosterEntry, "roster", QosProfile::kState, false);
LIMBCAST_TOPIC(roster::SessionState, "session", QosProfile::kState, false);
LIMBCAST_TOPIC(roster::JoinRequest, "join_request", QosProfile::kCommand, false);
LIMBCAST_TOPIC(roster::JoinReply, "join_reply", QosProfile::kCommand, false);
LIMBCAST_TOPIC(roster::Command, "command", QosProfile::kCommand, false);
LIMBCAST_TOPIC(roster::CommandReply, "command_reply", QosProfile::kCommand, false);
LIMBCAST_TOPIC(ServiceHealth, "health", QosProfile::kState, false);

#undef LIMBCAST_TOPIC

/// Every type that travels: the wire contract as a type list. A bus implements each of them.
using AllTopics =
    std::tuple<sensing::MargSample, sensing::MargFrame, sensing::FusedOrientation,
               sensing::CoilBurst, sensing::MarkerPosition, sensing::PositionFix,
               sensing::SensorInfo, body::SegmentState, body::SegmentFrame, body::SegmentTruth,
               body::BodyDefinition, body::Skeleton, body::JointAngleFrame, roster::RosterEntry,
               roster::SessionState, roster::JoinRequest, roster::JoinReply, roster::Command,
               roster::CommandReply, ServiceHealth>;

}  // namespace limbcast::bus
