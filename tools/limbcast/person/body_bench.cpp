#include "tools/limbcast/person/body_bench.hpp"

#include <fmt/format.h>

#include <utility>

#include "common/body/default_body.hpp"
#include "common/filters/filter_factory.hpp"

namespace limbcast::tool {
namespace {

constexpr BodyId kBody{1};

}  // namespace

Result<std::unique_ptr<BodyBench>> BodyBench::Make(
    const BodyTrialOptions& options, const std::vector<roster::SensorAssignment>& sensors,
    OnSkeleton on_skeleton) {
  if (auto made = filters::MakeFilter(options.filter, {}); !made) {
    return made.error();
  }
  auto definition = body::MakeDefaultBody(kBody, options.posture.body_height_m);
  if (!definition) {
    return definition.error();
  }
  std::unique_ptr<BodyBench> bench(new BodyBench(options));  // NOLINT: private constructor
  bench->tracker_ = std::make_unique<posture::BodyTracker>(
      options.posture, options.restored.value_or(*definition),
      [take = std::move(on_skeleton)](body::Skeleton& skeleton, posture::TickEnd, bool live) {
        if (live) {
          take(skeleton);
        }
      });
  const fusion::FilterFactory factory = [](std::string_view name) {
    return filters::MakeFilter(name, {});
  };
  roster::RosterEntry roster;
  roster.body_id = kBody;
  roster.sensors = sensors;
  for (const roster::SensorAssignment& sensor : sensors) {
    bench->tracks_.emplace(sensor.sensor_uid,
                           std::make_unique<fusion::SensorTrack>(
                               kBody,
                               fusion::TrackPlan{.sensor_uid = sensor.sensor_uid,
                                                 .segment = sensor.segment,
                                                 .filters = {.name = options.filter, .beside = ""}},
                               factory, std::chrono::hours(24)));
  }
  (void)bench->tracker_->SetRoster(roster);
  return bench;
}

template <typename Sample>
void BodyBench::Feed(Sample sample) {
  const auto track = tracks_.find(sample.sensor_uid);
  if (track == tracks_.end()) {
    return;
  }
  sample.sequence = ++sequence_[sample.sensor_uid];
  const auto output =
      track->second->Update(sample, {.received_at = sample.measured_at, .overloads = 0});
  for (const body::SegmentState& state : output.states) {
    if (state.slot == 0) {
      (void)tracker_->OnState(posture::MakeStateInput(state, sample.measured_at),
                              sample.measured_at);
    }
  }
}
template void BodyBench::Feed(sensing::MargSample sample);
template void BodyBench::Feed(sensing::FusedOrientation sample);

void BodyBench::EndTick(Time now, double time_s) {
  time_s_ = time_s;
  tracker_->OnDue(now);
  if (const auto calibrated = tracker_->TakeCalibrated()) {
    Note(*calibrated, true);
  }
  if (options_.reference_pose_s && time_s >= *options_.reference_pose_s && !posed_) {
    posed_ = true;
    Command(roster::CommandKind::kReferencePose, "", now);
    if (options_.walk_until_s) {
      Command(roster::CommandKind::kFunctionalCalibration, "start", now);
    }
  }
  if (options_.walk_until_s && time_s >= *options_.walk_until_s && !walked_) {
    walked_ = true;
    Command(roster::CommandKind::kFunctionalCalibration, "finish", now);
  }
}

body::BodyDefinition BodyBench::Definition() {
  tracker_->FoldHeadings();
  return tracker_->definition();
}

void BodyBench::Command(roster::CommandKind kind, std::string text, Time now) {
  roster::Command command;
  command.body_id = kBody;
  command.kind = kind;
  command.text = std::move(text);
  if (kind == roster::CommandKind::kReferencePose && options_.facing_rad) {
    command.numbers = {*options_.facing_rad};
  }
  const posture::CommandOutcome outcome = commands_.Execute(command, now, *tracker_);
  Note(outcome.message, outcome.accepted);
}

void BodyBench::Note(const std::string& what, bool good) {
  calibrated_ = good;
  events_.push_back(fmt::format("{:.2f} s: {}{}", time_s_, good ? "" : "refused: ", what));
}

}  // namespace limbcast::tool
