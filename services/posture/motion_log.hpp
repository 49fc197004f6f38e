#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/time.hpp"
#include "common/body/motion_record.hpp"
#include "common/body/segment.hpp"
#include "services/posture/tick_assembler.hpp"

namespace limbcast::posture {

/// The last half minute of all sensors of a body, at an even kRate_hz: samples of one sensor that
/// fall into the same 20 ms become one. Allocates when a segment is first heard, never after.
/// Thread-compatible.
class MotionLog {
 public:
  static constexpr double kRate_hz = 50.0;
  static constexpr double kSpan_s = 40.0;

  /// A time before the newest of the segment by more than the span begins its log anew.
  void Add(body::Segment segment, Time measured_at, const Eigen::Quaterniond& q_earth_sensor,
           const Eigen::Vector3f& free_accel_in_earth_m_s2);

  /// What these segments did in the `span_s` before `end`. Gaps up to kMaxGap_s are bridged; a
  /// segment with a longer one, or heard for only part of the time, is left out.
  [[nodiscard]] body::MotionRecord Extract(SegmentSet segments, Time end, double span_s) const;
  static constexpr double kMaxGap_s = 0.15;

  /// The newest instant of any segment.
  [[nodiscard]] std::optional<Time> newest() const;
  void Clear();

 private:
  static constexpr std::size_t kSlots = 2000;  // kRate_hz · kSpan_s
  struct Slot {
    std::int64_t bin = -1;
    float count = 0.0F;
    Eigen::Vector4f q_sum = Eigen::Vector4f::Zero();  // w x y z, signs made alike
    Eigen::Vector3f accel_sum_m_s2 = Eigen::Vector3f::Zero();
  };
  struct Lane {
    std::vector<Slot> slots;
    std::int64_t newest_bin = -1;
  };
  [[nodiscard]] bool ExtractOne(const Lane& lane, std::int64_t first, std::int64_t last,
                                body::SegmentRecord& motion) const;

  std::vector<Lane> lanes_ = std::vector<Lane>(body::kSegmentCount);
};

}  // namespace limbcast::posture
