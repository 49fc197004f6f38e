#pragma once

// Random values of every topic and their comparison, from a list of fields of its own: a field that
// the codecs forget shows as a difference.

#include <Eigen/Geometry>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "common/bus/topics.hpp"

namespace limbcast::bus::testing {

/// Lists the fields of a struct for `v`: v(field), v.Text(field, limit), v.Enum(field, last),
/// v.List(field, limit). B is the same struct again (compared) or ignored.
#define LIMBCAST_FIELDS(Type) \
  template <typename V>       \
  void Visit(V& v, Type& a, Type& b)
#define F(field) v(a.field, b.field)
#define TEXT(field, limit) v.Text(a.field, b.field, limit)
#define ENUM(field, last) v.Enum(a.field, b.field, last)
#define LIST(field, limit) v.List(a.field, b.field, limit)

LIMBCAST_FIELDS(sensing::MargSample) {
  F(sensor_uid), F(sequence), F(flags), F(measured_at), F(published_at), F(gyro_rad_s);
  F(accel_m_s2), F(mag_tesla), F(temperature_celsius);
}
LIMBCAST_FIELDS(sensing::MargFrame) { F(body_id), F(gateway), LIST(samples, 64); }
LIMBCAST_FIELDS(sensing::FusedOrientation) {
  F(sensor_uid), F(sequence), F(flags), F(measured_at), F(published_at), F(q_earth_sensor);
  ENUM(heading, HeadingReference::kTrue), F(gyro_rad_s), F(accel_m_s2), F(sigma_rad);
}
LIMBCAST_FIELDS(sensing::CoilPulse) {
  F(on_at), F(off_at), F(current_a), F(field_tesla), F(sigma_tesla), F(valid);
}
LIMBCAST_FIELDS(sensing::CoilBurst) {
  F(sensor_uid), F(source_uid), F(sequence), F(slot), F(measured_at), F(published_at);
  F(pulses[0]), F(pulses[1]), F(pulses[2]);
}
LIMBCAST_FIELDS(sensing::MarkerPosition) {
  F(body_id), F(marker), F(sequence), F(measured_at), F(published_at), F(p_earth_marker_m);
  F(sigma_m), F(visible);
}
LIMBCAST_FIELDS(sensing::PositionFix) {
  F(body_id), F(sequence), F(measured_at), F(published_at), F(p_earth_body_m), F(cov_m2);
}
LIMBCAST_FIELDS(sensing::SensorInfo) {
  F(sensor_uid), TEXT(driver, 32), TEXT(serial, 64), TEXT(label, 64), F(rate_hz);
  F(gyro_range_rad_s), F(accel_range_m_s2), F(mag_range_tesla), F(gyro_noise_rad_s_rthz);
  F(accel_noise_m_s2_rthz), F(mag_noise_tesla_rthz), TEXT(calibration, 64), F(calibrated_at);
}
LIMBCAST_FIELDS(body::StageTimes) {
  F(gateway_published_at), F(fusion_received_at), F(fusion_published_at);
  F(posture_received_at), F(posture_published_at);
}
LIMBCAST_FIELDS(body::SegmentState) {
  F(body_id), ENUM(segment, body::Segment::kLeftToe), F(slot), F(sensor_uid), F(sequence);
  ENUM(verdict, SampleVerdict::kRejectedOverload), F(started), F(degraded), F(at_rest);
  ENUM(magnetic_state, MagneticState::kDisturbed), ENUM(heading, HeadingReference::kTrue);
  F(measured_at), F(stages), F(q_earth_sensor), F(w_earth_sensor_in_sensor_rad_s);
  F(free_accel_in_earth_m_s2), F(cov_orientation_rad2), F(has_position), F(p_earth_sensor_m);
  F(v_earth_sensor_m_s), F(cov_position_m2), TEXT(filter, 16), F(lost_count);
  for (std::size_t i = 0; i < kSampleVerdictCount; ++i) {
    F(verdicts.count[i]);
  }
  ENUM(position_reference, PositionReference::kSensor);
  ENUM(position_from, body::Segment::kLeftToe), ENUM(position_fill, FillKind::kPolynomial);
}
LIMBCAST_FIELDS(body::SegmentFrame) { F(body_id), LIST(states, 64); }
LIMBCAST_FIELDS(body::SegmentTruth) {
  F(body_id), ENUM(segment, body::Segment::kLeftToe), F(sensor_uid), F(measured_at);
  F(sensor_valid), F(segment_valid), F(q_earth_sensor), F(q_earth_segment), F(p_earth_segment_m);
  F(p_earth_sensor_m);
}
LIMBCAST_FIELDS(body::SegmentDefinition) {
  ENUM(segment, body::Segment::kLeftToe), F(tracked), F(sensor_uid), F(p_parent_segment_m);
  F(p_segment_end_m), F(q_sensor_segment), F(heading_correction_rad), F(aligned);
  F(joint_min_rad), F(joint_max_rad);
}
LIMBCAST_FIELDS(body::BodyDefinition) {
  F(body_id), F(revision), F(changed_at), TEXT(name, 64), TEXT(reference_pose, 16);
  ENUM(heading, HeadingReference::kTrue), LIST(segments, 32);
}
LIMBCAST_FIELDS(body::SegmentPose) {
  ENUM(segment, body::Segment::kLeftToe), ENUM(status, body::SegmentStatus::kFilled);
  F(confidence), F(q_earth_segment), F(p_earth_segment_m);
}
LIMBCAST_FIELDS(body::Skeleton) {
  F(body_id), F(sequence), F(definition_revision), F(measured_at), F(stages), F(complete);
  F(contacts), LIST(segments, 32);
}
LIMBCAST_FIELDS(body::JointAngle) {
  ENUM(joint, body::Joint::kLeftWrist), F(near_singular), F(confidence), F(angle_rad);
}
LIMBCAST_FIELDS(body::JointAngleFrame) {
  F(body_id), F(sequence), F(measured_at), LIST(joints, 32);
}
LIMBCAST_FIELDS(roster::SensorAssignment) { F(sensor_uid), ENUM(segment, body::Segment::kLeftToe); }
LIMBCAST_FIELDS(roster::RosterEntry) {
  F(body_id), F(revision), TEXT(session, 64), TEXT(person, 64), LIST(sensors, 64), F(coil_slot);
  F(coil_slots), F(coil_frame_us);
}
LIMBCAST_FIELDS(roster::SessionState) {
  F(session_id), F(revision), TEXT(name, 64), TEXT(partition, 64), F(open), F(performer_count);
  F(created_at);
}
LIMBCAST_FIELDS(roster::JoinRequest) {
  F(client_uid), F(request_id), TEXT(session, 64), TEXT(person, 64);
  ENUM(role, roster::Role::kOperator), LIST(sensors, 64), F(wants_coil_slot);
}
LIMBCAST_FIELDS(roster::JoinReply) {
  F(client_uid), F(request_id), F(accepted), F(body_id), TEXT(partition, 64), TEXT(message, 255);
}
LIMBCAST_FIELDS(roster::Command) {
  F(client_uid), F(request_id), F(body_id), ENUM(kind, roster::CommandKind::kCountSessions);
  TEXT(text, 64), LIST(numbers, 64);
}
LIMBCAST_FIELDS(roster::CommandReply) {
  F(client_uid), F(request_id), F(accepted), TEXT(message, 255);
}
LIMBCAST_FIELDS(NamedValue) { TEXT(name, 48), F(value); }
LIMBCAST_FIELDS(LatencyQuantiles) { TEXT(stage, 32), F(count), F(p50_us), F(p99_us), F(max_us); }
LIMBCAST_FIELDS(ServiceHealth) {
  F(process_uid), TEXT(role, 32), TEXT(host, 64), F(pid), F(started_at), F(reported_at);
  F(cpu_seconds), F(rss_mib), LIST(values, 96), LIST(latencies, 16), TEXT(last_error, 255);
}

#undef LIMBCAST_FIELDS
#undef F
#undef TEXT
#undef ENUM
#undef LIST

/// Fills every field at random; texts and lists may have any length up to their bound.
class Randomiser {
 public:
  explicit Randomiser(std::mt19937_64& rng) : rng_(rng) {}

  template <typename T>
  void operator()(T& field, T& /*same*/) {
    if constexpr (std::is_same_v<T, bool>) {
      field = Below(2) == 1;
    } else if constexpr (std::is_floating_point_v<T>) {
      field = static_cast<T>(std::uniform_real_distribution<double>(-1e3, 1e3)(rng_));
    } else if constexpr (std::is_integral_v<T>) {
      field = static_cast<T>(rng_());
    } else if constexpr (std::is_same_v<T, SensorUid> || std::is_same_v<T, BodyId>) {
      (*this)(field.value, field.value);
    } else if constexpr (std::is_same_v<T, Time>) {
      field = TimeFromNanoseconds(static_cast<std::int64_t>(rng_()));
    } else if constexpr (requires { field.coeffs().size(); }) {  // Eigen
      for (Eigen::Index i = 0; i < field.coeffs().size(); ++i) {
        (*this)(field.coeffs().data()[i], field.coeffs().data()[i]);
      }
    } else if constexpr (requires {
                           field.size();
                           field.data();
                         }) {
      for (Eigen::Index i = 0; i < field.size(); ++i) {
        (*this)(field.data()[i], field.data()[i]);
      }
    } else {
      Visit(*this, field, field);
    }
  }
  void Text(std::string& field, std::string& /*same*/, std::size_t limit) {
    field.resize(Below(limit + 1));
    for (char& c : field) {
      c = static_cast<char>(1 + Below(255));  // any byte but NUL
    }
  }
  template <typename E>
  void Enum(E& field, E& /*same*/, E last) {
    field = static_cast<E>(Below(static_cast<std::size_t>(last) + 1));
  }
  template <typename E>
  void List(std::vector<E>& field, std::vector<E>& /*same*/, std::size_t limit) {
    field.resize(Below(limit + 1));
    for (E& element : field) {
      (*this)(element, element);
    }
  }

 private:
  std::size_t Below(std::size_t limit) { return rng_() % limit; }
  std::mt19937_64& rng_;
};

/// Bitwise comparison of every field.
class Comparer {
 public:
  bool equal = true;

  template <typename T>
  void operator()(T& a, T& b) {
    if constexpr (std::is_arithmetic_v<T>) {
      equal = equal && std::memcmp(&a, &b, sizeof(T)) == 0;
    } else if constexpr (std::is_same_v<T, SensorUid> || std::is_same_v<T, BodyId> ||
                         std::is_same_v<T, Time>) {
      equal = equal && a == b;
    } else if constexpr (requires { a.coeffs().size(); }) {
      equal = equal && a.coeffs() == b.coeffs();
    } else if constexpr (requires {
                           a.size();
                           a.data();
                         }) {
      equal = equal && a == b;
    } else {
      Visit(*this, a, b);
    }
  }
  void Text(const std::string& a, const std::string& b, std::size_t /*limit*/) {
    equal = equal && a == b;
  }
  template <typename E>
  void Enum(E a, E b, E /*last*/) {
    equal = equal && a == b;
  }
  template <typename E>
  void List(std::vector<E>& a, std::vector<E>& b, std::size_t /*limit*/) {
    equal = equal && a.size() == b.size();
    for (std::size_t i = 0; equal && i < a.size(); ++i) {
      (*this)(a[i], b[i]);
    }
  }
};

template <typename T>
T RandomValue(std::mt19937_64& rng) {
  T value;
  Randomiser randomiser(rng);
  randomiser(value, value);
  return value;
}

template <typename T>
bool Equal(const T& a, const T& b) {
  Comparer comparer;
  comparer(const_cast<T&>(a), const_cast<T&>(b));  // the visitor is shared with Randomiser
  return comparer.equal;
}

}  // namespace limbcast::bus::testing
