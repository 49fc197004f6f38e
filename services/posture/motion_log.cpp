#include "services/posture/motion_log.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/math/rotation.hpp"

namespace limbcast::posture {
namespace {

constexpr std::int64_t kBin_ns = 20'000'000;
static_assert(static_cast<double>(kBin_ns) * MotionLog::kRate_hz == 1e9);

std::int64_t BinOf(Time at) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(at.time_since_epoch()).count() /
         kBin_ns;
}

}  // namespace

void MotionLog::Add(body::Segment segment, Time measured_at,
                    const Eigen::Quaterniond& q_earth_sensor,
                    const Eigen::Vector3f& free_accel_in_earth_m_s2) {
  Lane& lane = lanes_[body::Index(segment)];
  if (lane.slots.empty()) {
    lane.slots.resize(kSlots);
  }
  const std::int64_t bin = BinOf(measured_at);
  Slot& slot = lane.slots[static_cast<std::size_t>(bin) % kSlots];
  if (slot.bin != bin) {
    slot = Slot{.bin = bin};
  }
  Eigen::Vector4f q(static_cast<float>(q_earth_sensor.w()), static_cast<float>(q_earth_sensor.x()),
                    static_cast<float>(q_earth_sensor.y()), static_cast<float>(q_earth_sensor.z()));
  slot.q_sum += slot.q_sum.dot(q) < 0.0F ? Eigen::Vector4f(-q) : q;
  slot.accel_sum_m_s2 += free_accel_in_earth_m_s2;
  slot.count += 1.0F;
  lane.newest_bin = bin;
}

bool MotionLog::ExtractOne(const Lane& lane, std::int64_t first, std::int64_t last,
                           body::SegmentRecord& motion) const {
  const auto max_gap = static_cast<std::int64_t>(kMaxGap_s * kRate_hz);
  if (lane.slots.empty()) {
    return false;
  }
  std::int64_t known = -1;  // the newest bin so far that holds something
  for (std::int64_t bin = first; bin <= last; ++bin) {
    const Slot& slot = lane.slots[static_cast<std::size_t>(bin) % kSlots];
    if (slot.bin != bin) {
      if (bin - std::max(known, first - 1) > max_gap) {
        return false;
      }
      continue;
    }
    const Eigen::Vector4d sum = slot.q_sum.cast<double>().normalized();
    const Eigen::Quaterniond q(sum[0], sum[1], sum[2], sum[3]);
    const Eigen::Vector3d accel = (slot.accel_sum_m_s2 / slot.count).cast<double>();
    const Eigen::Quaterniond q_before = known < 0 ? q : motion.q_earth_sensor.back();
    const Eigen::Vector3d accel_before = known < 0 ? accel : motion.accel_in_earth_m_s2.back();
    const std::int64_t from = known < 0 ? first - 1 : known;
    for (std::int64_t fill = from + 1; fill <= bin; ++fill) {
      const double share = static_cast<double>(fill - from) / static_cast<double>(bin - from);
      motion.q_earth_sensor.push_back(math::Slerp(q_before, q, share));
      motion.accel_in_earth_m_s2.emplace_back(accel_before + share * (accel - accel_before));
    }
    known = bin;
  }
  if (known < 0 || last - known > max_gap) {
    return false;
  }
  motion.q_earth_sensor.resize(static_cast<std::size_t>(last - first + 1),
                               motion.q_earth_sensor.back());
  motion.accel_in_earth_m_s2.resize(static_cast<std::size_t>(last - first + 1),
                                    motion.accel_in_earth_m_s2.back());
  return true;
}

body::MotionRecord MotionLog::Extract(SegmentSet segments, Time end, double span_s) const {
  body::MotionRecord record{.rate_hz = kRate_hz, .segments = {}};
  const std::int64_t last = BinOf(end);
  const auto length = static_cast<std::int64_t>(std::min(span_s, kSpan_s) * kRate_hz);
  const std::int64_t first = last - length + 1;
  if (first < 0) {
    return record;
  }
  for (const body::Segment segment : body::AllSegments()) {
    body::SegmentRecord motion;
    motion.segment = segment;
    if ((segments & BitOf(segment)) != 0 &&
        ExtractOne(lanes_[body::Index(segment)], first, last, motion)) {
      record.segments.push_back(std::move(motion));
    }
  }
  return record;
}

std::optional<Time> MotionLog::newest() const {
  std::int64_t bin = -1;
  for (const Lane& lane : lanes_) {
    bin = std::max(bin, lane.newest_bin);
  }
  if (bin < 0) {
    return std::nullopt;
  }
  return Time{} + std::chrono::nanoseconds(bin * kBin_ns);
}

void MotionLog::Clear() {
  for (Lane& lane : lanes_) {
    lane = Lane{};
  }
}

}  // namespace limbcast::posture
