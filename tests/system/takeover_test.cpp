// Two of each service, one of them stronger: kill -9 of the stronger one, and the weaker one, which
// has filtered the same samples all the time, is heard. A walking person must not jump.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "common/bus/bus_factory.hpp"
#include "common/math/rotation.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/units/units.hpp"
#include "tests/system/program.hpp"
#include "tools/limbcast/demo/reference_pose.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using namespace test_support;

constexpr BodyId kBody{1};

// Libraries of the primary and of the standby services; the gateway is with the primary.
struct Vendors {
  const char* name;
  const char* primary;
  const char* standby;
};

// One orientation that was shown.
struct Shown {
  Time measured_at{};
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

// What a client sees of segments and sensors, against the truth of the simulator.
class Watcher {
 public:
  explicit Watcher(bus::Bus& bus) {
    truths_ = bus.MakeReader<body::SegmentTruth>(
                     {.on_sample = [this](const auto& truth, const auto&) { On(truth); },
                      .on_disposed = {}})
                  .value();
    states_ = bus.MakeReader<body::SegmentState>(
                     {.on_sample = [this](const auto& state, const auto&) { On(state); },
                      .on_disposed = {}})
                  .value();
    skeletons_ = bus.MakeReader<body::Skeleton>(
                        {.on_sample = [this](const auto& skeleton, const auto&) { On(skeleton); },
                         .on_disposed = {}})
                     .value();
    health_ = bus.MakeReader<ServiceHealth>(
                     {.on_sample = [this](const auto& health, const auto&) { On(health); },
                      .on_disposed = {}})
                  .value();
  }

  [[nodiscard]] std::size_t skeletons() {
    const std::scoped_lock lock(mutex_);
    return skeleton_times_.size();
  }
  [[nodiscard]] int state_writers() const { return states_->counters().alive_writers; }
  [[nodiscard]] int skeleton_writers() const { return skeletons_->counters().alive_writers; }

  // Posture services that have taken an alignment over from another one.
  [[nodiscard]] std::size_t adopters() {
    const std::scoped_lock lock(mutex_);
    return adopters_.size();
  }

  struct Handover {
    Duration gap{};                     // longest between two skeletons
    double worst_jump_rad = 0.0;        // of a segment over that gap
    double worst_state_jump_rad = 0.0;  // of a sensor over its longest gap
    std::size_t segments = 0;
  };
  // Since the last Forget. The truth comes later than what is compared with it, so only now.
  [[nodiscard]] Handover Measure() {
    const std::scoped_lock lock(mutex_);
    Handover result;
    for (std::size_t i = 1; i < skeleton_times_.size(); ++i) {
      result.gap = std::max(result.gap, skeleton_times_[i] - skeleton_times_[i - 1]);
    }
    result.segments = segments_shown_.size();
    for (const auto& [segment, shown] : segments_shown_) {
      result.worst_jump_rad = std::max(
          result.worst_jump_rad,
          JumpOverLongestGap(Errors(shown, known_[segment], &body::SegmentTruth::q_earth_segment)));
    }
    for (const auto& [segment, shown] : sensors_shown_) {
      result.worst_state_jump_rad = std::max(
          result.worst_state_jump_rad,
          JumpOverLongestGap(Errors(shown, known_[segment], &body::SegmentTruth::q_earth_sensor)));
    }
    return result;
  }
  void Forget() {
    const std::scoped_lock lock(mutex_);
    known_.clear();
    skeleton_times_.clear();
    segments_shown_.clear();
    sensors_shown_.clear();
  }

 private:
  using Truths = std::map<Time, body::SegmentTruth>;

  // What was shown, less the truth, in the earth frame: shown · truth⁻¹.
  static std::vector<Shown> Errors(const std::vector<Shown>& shown, const Truths& truths,
                                   Eigen::Quaterniond body::SegmentTruth::*what) {
    std::vector<Shown> errors;
    for (const Shown& one : shown) {
      if (const auto truth = truths.find(one.measured_at); truth != truths.end()) {
        errors.push_back({one.measured_at, one.q * (truth->second.*what).conjugate()});
      }
    }
    return errors;
  }

  // How much more the error changes over the longest gap than it did in as long a time before it:
  // the error of a segment that is a little misplaced turns with the segment, all the time.
  static double JumpOverLongestGap(const std::vector<Shown>& errors) {
    const auto length = [&](std::size_t i) {
      return errors[i].measured_at - errors[i - 1].measured_at;
    };
    std::size_t after = 0;
    for (std::size_t i = 1; i < errors.size(); ++i) {
      after = after == 0 || length(i) > length(after) ? i : after;
    }
    if (after == 0) {
      ADD_FAILURE() << "nothing shown of which the truth is known";
      return 0.0;
    }
    double usual_rad = 0.0;
    for (std::size_t i = 0, later = 0; later < after; ++i) {
      while (later < after && errors[later].measured_at - errors[i].measured_at < length(after)) {
        ++later;
      }
      if (later < after) {
        usual_rad = std::max(usual_rad, math::AngleBetween_rad(errors[i].q, errors[later].q));
      }
    }
    const double jump_rad = math::AngleBetween_rad(errors[after - 1].q, errors[after].q);
    return std::max(0.0, jump_rad - usual_rad);
  }

  void On(const body::SegmentTruth& truth) {
    const std::scoped_lock lock(mutex_);
    known_[truth.segment][truth.measured_at] = truth;
  }
  void On(const body::SegmentState& state) {
    const std::scoped_lock lock(mutex_);
    if (state.started && state.slot == 0) {
      sensors_shown_[state.segment].push_back({state.measured_at, state.q_earth_sensor});
    }
  }
  void On(const body::Skeleton& skeleton) {
    const std::scoped_lock lock(mutex_);
    skeleton_times_.push_back(skeleton.measured_at);
    for (const body::SegmentPose& pose : skeleton.segments) {
      if (pose.status == body::SegmentStatus::kTracked) {
        segments_shown_[pose.segment].push_back(
            {skeleton.measured_at, pose.q_earth_segment.cast<double>()});
      }
    }
  }

  void On(const ServiceHealth& health) {
    const std::scoped_lock lock(mutex_);
    for (const NamedValue& value : health.values) {
      if (value.name == "adopted" && value.value > 0.0) {
        adopters_.insert(health.process_uid);
      }
    }
  }

  std::mutex mutex_;  // guards all values
  std::set<std::uint64_t> adopters_;
  std::map<body::Segment, Truths> known_;
  std::vector<Time> skeleton_times_;
  std::map<body::Segment, std::vector<Shown>> segments_shown_;
  std::map<body::Segment, std::vector<Shown>> sensors_shown_;
  std::unique_ptr<bus::Reader<body::SegmentTruth>> truths_;
  std::unique_ptr<bus::Reader<body::SegmentState>> states_;
  std::unique_ptr<bus::Reader<body::Skeleton>> skeletons_;
  std::unique_ptr<bus::Reader<ServiceHealth>> health_;
};

class TakeoverTest : public ::testing::TestWithParam<Vendors> {
 protected:
  static constexpr const char* kLease = "bus.stream_lease_s=0.1";

  process::ChildProcess Start(const std::string& program, const std::string& dds, int strength,
                              std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {Program(program),
                                          "--dds",
                                          dds,
                                          "--domain",
                                          std::to_string(domain_),
                                          "--set",
                                          kLease,
                                          "--set",
                                          "bus.ownership_strength=" + std::to_string(strength)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto started = process::ChildProcess::Start({.arguments = arguments});
    EXPECT_TRUE(started.ok());
    return std::move(*started);
  }

  void SetUp() override {
    domain_ = OwnDomain();
    bus::BusConfig config;
    config.vendor = bus::ParseVendor(GetParam().standby).value();
    config.domain_id = domain_;
    config.stream_lease = 100ms;
    config.stream_depth = 1024;
    bus_ = bus::Open(config).value();
    watcher_ = std::make_unique<Watcher>(*bus_);
    pose_ = tool::ReferencePose::Make(*bus_).value();
  }

  void Await(Duration patience, const std::function<bool()>& done, const char* what) {
    ASSERT_TRUE(Eventually(patience, done)) << what;
  }

  // Kills one process and tells what its successor does.
  Watcher::Handover Kill(process::ChildProcess& victim, const char* what) {
    watcher_->Forget();
    // More than a stride, for what the error does by itself.
    EXPECT_TRUE(Eventually(20s, [&] { return watcher_->skeletons() > 150; }));
    victim.Signal(SIGKILL);
    EXPECT_TRUE(victim.Wait(10s).has_value());
    EXPECT_TRUE(Eventually(20s, [&] { return watcher_->skeletons() > 350; })) << "nobody took over";
    const Watcher::Handover handover = watcher_->Measure();
    std::printf("%s, %s killed: gap %.0f ms, jump %.2f deg, of the sensors %.2f deg\n",
                GetParam().name, what, 1e3 * ToSeconds(handover.gap),
                units::DegFromRad(handover.worst_jump_rad),
                units::DegFromRad(handover.worst_state_jump_rad));
    RecordProperty(std::string("gap_ms_") + what, static_cast<int>(1e3 * ToSeconds(handover.gap)));
    return handover;
  }

  std::uint32_t domain_ = 0;
  std::unique_ptr<bus::Bus> bus_;
  std::unique_ptr<Watcher> watcher_;
  std::unique_ptr<tool::ReferencePose> pose_;
  runtime::SystemClock clock_;
};

TEST_P(TakeoverTest, AKilledFusionAndPostureAreTakenOverWithoutAJump) {
  const Vendors& vendors = GetParam();
  constexpr int kStrong = 20;
  constexpr int kWeak = 10;
  auto posture = Start("limbcast-posture", vendors.primary, kStrong);
  auto fusion = Start("limbcast-fusion", vendors.primary, kStrong);
  auto fusion_standby = Start("limbcast-fusion", vendors.standby, kWeak);
  auto gateway = Start("limbcast-gateway", vendors.primary, kStrong,
                       {"--wait-for", "posture", "--set", "simulator.n_pose_s=6"});
  Await(
      30s, [&] { return watcher_->skeletons() > 250; }, "skeletons");
  Await(
      10s,
      [&] {
        pose_->Ask(kBody, clock_.Now());
        return pose_->accepted();
      },
      "reference pose");
  // Started after the alignment: what it knows of that is what the primary has published.
  auto posture_standby = Start("limbcast-posture", vendors.standby, kWeak);
  Await(
      20s, [&] { return watcher_->state_writers() == 2 && watcher_->skeleton_writers() == 2; },
      "two of each service");
  Await(
      20s, [&] { return watcher_->adopters() == 1; }, "the alignment taken over");

  const Watcher::Handover of_fusion = Kill(fusion, "fusion");
  const Watcher::Handover of_posture = Kill(posture, "posture");
  for (const Watcher::Handover& handover : {of_fusion, of_posture}) {
    EXPECT_GE(handover.segments, 15U);
    EXPECT_LE(units::DegFromRad(handover.worst_jump_rad), 1.0);
  }
  EXPECT_LE(units::DegFromRad(of_fusion.worst_state_jump_rad), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Dds, TakeoverTest,
                         ::testing::Values(Vendors{"cyclone", "cyclone", "cyclone"},
                                           Vendors{"fast", "fast", "fast"},
                                           Vendors{"cyclone_then_fast", "cyclone", "fast"},
                                           Vendors{"fast_then_cyclone", "fast", "cyclone"}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace limbcast
