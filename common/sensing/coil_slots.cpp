#include "common/sensing/coil_slots.hpp"

#include <cmath>
#include <numbers>

#include "common/base/range.hpp"
#include "common/sensing/coil_field.hpp"

namespace limbcast::sensing {
namespace {

// Since the last slot of the grant began; below one frame, also before 1970.
Duration SinceSlot(const CoilGrant& grant, Time at) {
  const Duration since = (at.time_since_epoch() - grant.slot * grant.slot_length()) % grant.frame;
  return since < Duration{} ? since + grant.frame : since;
}

}  // namespace

Status Validate(const CoilSlotConfig& c) {
  return CheckRanges("coil slots: ", {{"pulse_s", c.pulse_s, 1e-3, 1.0},
                                      {"clock_error_s", c.clock_error_s, 0.0, 0.1},
                                      {"tail_s", c.tail_s, 0.0, 0.1},
                                      {"free_running_hz", c.free_running_hz, 0.0, 1e5},
                                      {"background_s", c.background_s, 0.0, 1.0},
                                      {"burst_rate_hz", c.burst_rate_hz, 0.01, 100.0},
                                      {"moment_a_m2", c.moment_a_m2, 1e-3, 100.0},
                                      {"harmless_tesla", c.harmless_tesla, 1e-12, 1e-6}});
}

CoilSlotPlan PlanCoilSlots(const CoilSlotConfig& c) {
  CoilSlotPlan plan;
  plan.guard_s = 2.0 * c.clock_error_s + c.tail_s;
  if (c.free_running_hz > 0.0) {
    plan.guard_s += 1.0 / c.free_running_hz;
  }
  plan.slot_s = c.pulse_s + plan.guard_s;
  plan.slots_per_s = 1.0 / plan.slot_s;
  plan.burst_s = 3.0 * plan.slot_s + c.background_s;
  plan.bursts_per_s = 1.0 / plan.burst_s;
  plan.users = plan.bursts_per_s / c.burst_rate_hz;
  plan.reuse_distance_m = std::cbrt(ForeignField_tesla(c.moment_a_m2, 1.0) / c.harmless_tesla);
  plan.duty = 3.0 * c.pulse_s * c.burst_rate_hz;
  return plan;
}

double ForeignField_tesla(double moment_a_m2, double distance_m) {
  return std::numbers::sqrt2 * kMu0_t_m_a * moment_a_m2 /
         (4.0 * std::numbers::pi * std::pow(distance_m, 3));
}

bool IsInSlot(const CoilGrant& grant, Time at) {
  return SinceSlot(grant, at) < grant.slot_length();
}

Time NextSlotBegin(const CoilGrant& grant, Time at) {
  const Duration since = SinceSlot(grant, at);
  return since == Duration{} ? at : at + (grant.frame - since);
}

}  // namespace limbcast::sensing
