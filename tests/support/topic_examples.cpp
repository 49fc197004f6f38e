#include "tests/support/topic_examples.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <tuple>

#include "common/base/expects.hpp"
#include "common/bus/wire/codec.hpp"
#include "common/bus/wire/wire_types.hpp"
#include "tests/support/draw.hpp"

namespace limbcast::test_support {
namespace {

body::StageTimes Stages(Draw& draw) {
  return {draw.Instant(), draw.Instant(), draw.Instant(), draw.Instant(), draw.Instant()};
}

constexpr std::uint32_t kSegments = body::kSegmentCount;

sensing::MargSample Marg(Draw& draw, std::uint64_t uid, std::uint32_t sequence) {
  return {.sensor_uid = {uid},
          .sequence = sequence,
          .flags = draw.Below(16384),
          .measured_at = draw.Instant(),
          .published_at = draw.Instant(),
          .gyro_rad_s = draw.Vector3f(),
          .accel_m_s2 = draw.Vector3f(),
          .mag_tesla = draw.Vector3f(),
          .temperature_celsius = draw.Single()};
}

// One overload pair for each topic: Fill makes the value, KeyAndSequence reads both numbers back.
using Numbers = std::pair<std::uint32_t, std::uint32_t>;
Numbers Pair(std::uint64_t key, std::uint64_t sequence) {
  return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(sequence)};
}

void Fill(sensing::MargSample& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = Marg(draw, key, sequence);
}
Numbers KeyAndSequence(const sensing::MargSample& v) {
  return Pair(v.sensor_uid.value, v.sequence);
}

void Fill(sensing::MargFrame& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.body_id = {key};
  v.gateway = key % 3;
  for (std::uint32_t i = 0; i <= draw.Below(sensing::kMaxSamplesPerFrame); ++i) {
    v.samples.push_back(Marg(draw, draw.Bits(), sequence));
  }
}
Numbers KeyAndSequence(const sensing::MargFrame& v) {
  return Pair(v.body_id.value, v.samples.empty() ? 0 : v.samples.front().sequence);
}

void Fill(sensing::FusedOrientation& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {.sensor_uid = {key},
       .sequence = sequence,
       .flags = draw.Below(1024),
       .measured_at = draw.Instant(),
       .published_at = draw.Instant(),
       .q_earth_sensor = draw.Rotation(),
       .heading = draw.OneOf<HeadingReference>(3),
       .gyro_rad_s = draw.Vector3f(),
       .accel_m_s2 = draw.Vector3f(),
       .sigma_rad = draw.Single()};
}
Numbers KeyAndSequence(const sensing::FusedOrientation& v) {
  return Pair(v.sensor_uid.value, v.sequence);
}

void Fill(sensing::CoilBurst& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.sensor_uid = {key};
  v.source_uid = {0xFEDC'BA98'0000'0000ULL + key};
  v.sequence = sequence;
  v.slot = draw.Below(100);
  v.measured_at = draw.Instant();
  v.published_at = draw.Instant();
  for (sensing::CoilPulse& pulse : v.pulses) {
    pulse = {draw.Instant(),  draw.Instant(), draw.Single(),
             draw.Vector3f(), draw.Single(),  draw.Coin()};
  }
}
Numbers KeyAndSequence(const sensing::CoilBurst& v) { return Pair(v.sensor_uid.value, v.sequence); }

void Fill(sensing::MarkerPosition& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {.body_id = {key / 50},
       .marker = key % 50,
       .sequence = sequence,
       .measured_at = draw.Instant(),
       .published_at = draw.Instant(),
       .p_earth_marker_m = draw.Vector3d(),
       .sigma_m = draw.Single(),
       .visible = draw.Coin()};
}
Numbers KeyAndSequence(const sensing::MarkerPosition& v) {
  return Pair(v.body_id.value * 50U + v.marker, v.sequence);
}

void Fill(sensing::PositionFix& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {.body_id = {key},
       .sequence = sequence,
       .measured_at = draw.Instant(),
       .published_at = draw.Instant(),
       .p_earth_body_m = draw.Vector3d(),
       .cov_m2 = draw.Matrix3d()};
}
Numbers KeyAndSequence(const sensing::PositionFix& v) { return Pair(v.body_id.value, v.sequence); }

void Fill(sensing::SensorInfo& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {.sensor_uid = {key},
       .driver = draw.Text(32),
       .serial = draw.Text(64),
       .label = draw.Text(64),
       .rate_hz = draw.Real(),
       .gyro_range_rad_s = draw.Single(),
       .accel_range_m_s2 = draw.Single(),
       .mag_range_tesla = draw.Single(),
       .gyro_noise_rad_s_rthz = draw.Single(),
       .accel_noise_m_s2_rthz = draw.Single(),
       .mag_noise_tesla_rthz = draw.Single(),
       .calibration = draw.Text(64),
       .calibrated_at = TimeFromNanoseconds(sequence)};
}
Numbers KeyAndSequence(const sensing::SensorInfo& v) {
  return Pair(v.sensor_uid.value, static_cast<std::uint64_t>(ToNanoseconds(v.calibrated_at)));
}

void Fill(body::SegmentState& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.body_id = {key / kSegments};
  v.segment = static_cast<body::Segment>(key % kSegments);
  v.slot = 1;
  v.sensor_uid = {draw.Bits()};
  v.sequence = sequence;
  v.verdict = draw.OneOf<SampleVerdict>(kSampleVerdictCount);
  v.started = draw.Coin();
  v.degraded = draw.Coin();
  v.at_rest = draw.Coin();
  v.magnetic_state = draw.OneOf<MagneticState>(3);
  v.heading = draw.OneOf<HeadingReference>(3);
  v.measured_at = draw.Instant();
  v.stages = Stages(draw);
  v.q_earth_sensor = draw.Rotation();
  v.w_earth_sensor_in_sensor_rad_s = draw.Vector3f();
  v.free_accel_in_earth_m_s2 = draw.Vector3f();
  v.cov_orientation_rad2 = draw.Matrix3f();
  v.has_position = draw.Coin();
  v.p_earth_sensor_m = draw.Vector3f();
  v.v_earth_sensor_m_s = draw.Vector3f();
  v.cov_position_m2 = draw.Matrix3f();
  v.filter = draw.Text(16);
  v.lost_count = draw.Bits();
  for (std::uint64_t& count : v.verdicts.count) {
    count = draw.Bits();
  }
  v.position_reference = draw.OneOf<PositionReference>(2);
  v.position_from = draw.Segment();
  v.position_fill = draw.OneOf<FillKind>(5);
}
Numbers KeyAndSequence(const body::SegmentState& v) {
  return Pair(v.body_id.value * kSegments + body::Index(v.segment), v.sequence);
}

void Fill(body::SegmentFrame& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.body_id = {key};
  v.states.resize(1 + draw.Below(body::kMaxStatesPerFrame));
  for (body::SegmentState& state : v.states) {
    Fill(state, draw, key * kSegments, sequence);
  }
}
Numbers KeyAndSequence(const body::SegmentFrame& v) {
  return Pair(v.body_id.value, v.states.empty() ? 0 : v.states.front().sequence);
}

void Fill(body::SegmentTruth& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {.body_id = {key / kSegments},
       .segment = static_cast<body::Segment>(key % kSegments),
       .sensor_uid = {draw.Bits()},
       .measured_at = TimeFromNanoseconds(sequence),
       .sensor_valid = draw.Coin(),
       .segment_valid = draw.Coin(),
       .q_earth_sensor = draw.Rotation(),
       .q_earth_segment = draw.Rotation(),
       .p_earth_segment_m = draw.Vector3d(),
       .p_earth_sensor_m = draw.Vector3d()};
}
Numbers KeyAndSequence(const body::SegmentTruth& v) {
  return Pair(v.body_id.value * kSegments + body::Index(v.segment),
              static_cast<std::uint64_t>(ToNanoseconds(v.measured_at)));
}

void Fill(body::BodyDefinition& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.body_id = {key};
  v.revision = sequence;
  v.changed_at = draw.Instant();
  v.name = draw.Text(64);
  v.reference_pose = draw.Text(16);
  v.heading = draw.OneOf<HeadingReference>(3);
  v.segments.resize(draw.Below(33));
  for (body::SegmentDefinition& segment : v.segments) {
    segment = {.segment = draw.Segment(),
               .tracked = draw.Coin(),
               .sensor_uid = {draw.Bits()},
               .p_parent_segment_m = draw.Vector3d(),
               .p_segment_end_m = draw.Vector3d(),
               .q_sensor_segment = draw.Rotation(),
               .heading_correction_rad = draw.Vector3d().z(),
               .aligned = draw.Coin(),
               .joint_min_rad = draw.Vector3d(),
               .joint_max_rad = draw.Vector3d()};
  }
}
Numbers KeyAndSequence(const body::BodyDefinition& v) { return Pair(v.body_id.value, v.revision); }

void Fill(body::Skeleton& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.body_id = {key};
  v.sequence = sequence;
  v.definition_revision = draw.Below(9);
  v.measured_at = draw.Instant();
  v.stages = Stages(draw);
  v.complete = draw.Coin();
  v.contacts = draw.Below(1U << 23U);
  v.segments.resize(draw.Below(33));
  for (body::SegmentPose& pose : v.segments) {
    pose = {.segment = draw.Segment(),
            .status = draw.OneOf<body::SegmentStatus>(4),
            .confidence = draw.Single(),
            .q_earth_segment = draw.Rotation().cast<float>(),
            .p_earth_segment_m = draw.Vector3f()};
  }
}
Numbers KeyAndSequence(const body::Skeleton& v) { return Pair(v.body_id.value, v.sequence); }

void Fill(body::JointAngleFrame& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.body_id = {key};
  v.sequence = sequence;
  v.measured_at = draw.Instant();
  v.joints.resize(draw.Below(33));
  for (body::JointAngle& angle : v.joints) {
    angle = {.joint = draw.OneOf<body::Joint>(body::kJointCount),
             .near_singular = draw.Coin(),
             .confidence = draw.Single(),
             .angle_rad = draw.Vector3f()};
  }
}
Numbers KeyAndSequence(const body::JointAngleFrame& v) { return Pair(v.body_id.value, v.sequence); }

std::vector<roster::SensorAssignment> Assignments(Draw& draw) {
  std::vector<roster::SensorAssignment> sensors(draw.Below(65));
  for (roster::SensorAssignment& sensor : sensors) {
    sensor = {{draw.Bits()}, draw.Segment()};
  }
  return sensors;
}

void Fill(roster::RosterEntry& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.body_id = {key};
  v.revision = sequence;
  v.session = draw.Text(64);
  v.person = draw.Text(64);
  v.sensors = Assignments(draw);
  v.coil_slot = draw.Below(100);
  v.coil_slots = draw.Below(100);
  v.coil_frame_us = draw.Below(1'000'000);
}
Numbers KeyAndSequence(const roster::RosterEntry& v) { return Pair(v.body_id.value, v.revision); }

void Fill(roster::SessionState& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {.session_id = key,
       .revision = sequence,
       .name = draw.Text(64),
       .partition = draw.Text(64),
       .open = draw.Coin(),
       .performer_count = draw.Below(100),
       .created_at = draw.Instant()};
}
Numbers KeyAndSequence(const roster::SessionState& v) { return Pair(v.session_id, v.revision); }

void Fill(roster::JoinRequest& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {key, sequence, draw.Text(64), draw.Text(64), draw.OneOf<roster::Role>(3), {}};
  v.sensors = Assignments(draw);
  v.wants_coil_slot = draw.Coin();
}
Numbers KeyAndSequence(const roster::JoinRequest& v) { return Pair(v.client_uid, v.request_id); }

void Fill(roster::JoinReply& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {key, sequence, draw.Coin(), {draw.Below(99)}, draw.Text(64), draw.Text(255)};
}
Numbers KeyAndSequence(const roster::JoinReply& v) { return Pair(v.client_uid, v.request_id); }

void Fill(roster::Command& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {key, sequence, {draw.Below(99)}, draw.OneOf<roster::CommandKind>(5), draw.Text(64), {}};
  v.numbers.resize(draw.Below(65));
  for (double& number : v.numbers) {
    number = draw.Real();
  }
}
Numbers KeyAndSequence(const roster::Command& v) { return Pair(v.client_uid, v.request_id); }

void Fill(roster::CommandReply& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v = {key, sequence, draw.Coin(), draw.Text(255)};
}
Numbers KeyAndSequence(const roster::CommandReply& v) { return Pair(v.client_uid, v.request_id); }

void Fill(ServiceHealth& v, Draw& draw, std::uint32_t key, std::uint32_t sequence) {
  v.process_uid = key;
  v.role = draw.Text(32);
  v.host = draw.Text(64);
  v.pid = sequence;
  v.started_at = draw.Instant();
  v.reported_at = draw.Instant();
  v.cpu_seconds = draw.Real();
  v.rss_mib = draw.Real();
  v.values.resize(draw.Below(97));
  for (NamedValue& value : v.values) {
    value = {draw.Text(48), draw.Real()};
  }
  v.latencies.resize(draw.Below(17));
  for (LatencyQuantiles& quantiles : v.latencies) {
    quantiles = {draw.Text(32), draw.Bits(), draw.Single(), draw.Single(), draw.Single()};
  }
  v.last_error = draw.Text(255);
}
Numbers KeyAndSequence(const ServiceHealth& v) { return Pair(v.process_uid, v.pid); }

}  // namespace

template <typename T>
T Example(std::uint32_t key, std::uint32_t sequence) {
  Draw draw(key, sequence);
  T value;
  Fill(value, draw, key, sequence);
  return value;
}

template <typename T>
std::uint32_t ExampleKey(const T& value) {
  return KeyAndSequence(value).first;
}

template <typename T>
std::uint32_t ExampleSequence(const T& value) {
  return KeyAndSequence(value).second;
}

template <typename T>
std::string WireBytes(const T& value) {
  typename bus::Codec<T>::Wire wire;
  Expects(bus::Codec<T>::Encode(value, wire).ok(), "a value within its bounds");
  std::string bytes(bus::Codec<T>::Wire::getMaxCdrSerializedSize() + 8, '\0');
  eprosima::fastcdr::FastBuffer buffer(bytes.data(), bytes.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  wire.serialize(cdr);
  bytes.resize(cdr.getSerializedDataLength());
  return bytes;
}

#define LIMBCAST_EXAMPLES(T)                           \
  template T Example<T>(std::uint32_t, std::uint32_t); \
  template std::uint32_t ExampleKey<T>(const T&);      \
  template std::uint32_t ExampleSequence<T>(const T&); \
  template std::string WireBytes<T>(const T&)
LIMBCAST_EXAMPLES(sensing::MargSample);
LIMBCAST_EXAMPLES(sensing::MargFrame);
LIMBCAST_EXAMPLES(sensing::FusedOrientation);
LIMBCAST_EXAMPLES(sensing::CoilBurst);
LIMBCAST_EXAMPLES(sensing::MarkerPosition);
LIMBCAST_EXAMPLES(sensing::PositionFix);
LIMBCAST_EXAMPLES(sensing::SensorInfo);
LIMBCAST_EXAMPLES(body::SegmentState);
LIMBCAST_EXAMPLES(body::SegmentFrame);
LIMBCAST_EXAMPLES(body::SegmentTruth);
LIMBCAST_EXAMPLES(body::BodyDefinition);
LIMBCAST_EXAMPLES(body::Skeleton);
LIMBCAST_EXAMPLES(body::JointAngleFrame);
LIMBCAST_EXAMPLES(roster::RosterEntry);
LIMBCAST_EXAMPLES(roster::SessionState);
LIMBCAST_EXAMPLES(roster::JoinRequest);
LIMBCAST_EXAMPLES(roster::JoinReply);
LIMBCAST_EXAMPLES(roster::Command);
LIMBCAST_EXAMPLES(roster::CommandReply);
LIMBCAST_EXAMPLES(ServiceHealth);

}  // namespace limbcast::test_support
