#include "tools/limbcast/demo/demo.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "common/bus/bus_factory.hpp"
#include "common/runtime/process_usage.hpp"
#include "common/runtime/sleeper.hpp"

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;

constexpr Duration kLook = 50ms;            // how often the children are looked after
constexpr Duration kPatience = 20s;         // for everybody to find each other
constexpr Duration kSettle = 500ms;         // after the pose, before errors count
constexpr double kStandBeforePose_s = 2.5;  // the filters have found their orientation by then

// The simulated person, and the one of a recording at the pace of life, stand still at first.
bool StandsAtFirst(const DemoOptions& options) {
  return options.recording.empty() || (!options.speed.empty() && options.speed != "max");
}

}  // namespace

Result<nlohmann::json> Demo::Run() {
  const auto refuse = [&](const Status& status) {
    for (const Part part : {Part::kGateway, Part::kFusion, Part::kPosture}) {
      processes_.Stop(part);
    }
    return status.error();
  };
  if (const Status begun = Begin(); !begun) {
    return refuse(begun);
  }
  if (const Status watched = Watch(); !watched) {
    return refuse(watched);
  }
  End();
  nlohmann::json summary = SumUp();
  if (!options_.quiet) {
    fmt::print("{}", SummaryText(summary));
  }
  if (const std::string errors = processes_.Errors(); !errors.empty() && !ended_cleanly_) {
    fmt::print(stderr, "{}", errors);
  }
  return summary;
}

template <typename Done>
Status Demo::Await(Duration patience, const std::string& what, Done&& done) {
  const Time deadline = clock_.Now() + patience;
  while (!done()) {
    if (Status alive = processes_.Supervise(); !alive) {
      return alive;
    }
    if (stop_signal_.WaitFor(kLook)) {
      return Error{ErrorCode::kUnavailable, "stopped before " + what};
    }
    if (clock_.Now() > deadline) {
      return Error{ErrorCode::kTimeout,
                   fmt::format("no {} within {} s on domain {}", what,
                               std::chrono::duration_cast<std::chrono::seconds>(patience).count(),
                               options_.bus.domain_id)};
    }
  }
  return Ok();
}

Status Demo::Begin() {
  auto bus = bus::Open(options_.bus);
  if (!bus) {
    return bus.error();
  }
  bus_ = std::move(*bus);
  // Recordings may know the truth of the sensors only: that is compared with segment states.
  auto view = PipelineView::Make(
      *bus_, {.segment_states = options_.segment_states || !options_.recording.empty() ||
                                options_.coils || options_.markers,
              .truth = true});
  if (!view) {
    return view.error();
  }
  view_ = std::move(*view);
  view_->With(
      [&](PipelineModel& model) { model.judge_positions = options_.coils || options_.markers; });
  auto reference_pose = ReferencePose::Make(*bus_);
  if (!reference_pose) {
    return reference_pose.error();
  }
  reference_pose_ = std::move(*reference_pose);

  if (!options_.quiet) {
    fmt::print("limbcast demo: {} on {}, domain {}\n",
               options_.recording.empty() ? "a simulated person" : options_.recording,
               ToString(options_.dds), options_.bus.domain_id);
  }
  // From the end to the beginning, so that nothing is sent that nobody hears.
  for (const Part part : {Part::kPosture, Part::kFusion}) {
    if (Status started = processes_.Start(part); !started) {
      return started;
    }
  }
  if (Status heard = Await(
          kPatience, "sign of life from limbcast-fusion and limbcast-posture",
          [&] {
            return view_->skeleton_writers() > 0 && view_->With([](const PipelineModel& model) {
              return model.health.HasRole("fusion") && model.health.HasRole("posture");
            });
          });
      !heard) {
    return heard;
  }
  if (Status started = processes_.Start(Part::kGateway); !started) {
    return started;
  }
  return Await(kPatience, "skeleton from the pipeline", [&] {
    return processes_.gateway_finished() ||
           view_->With([](const PipelineModel& model) { return model.skeletons() > 0; });
  });
}

Status Demo::Watch() {
  started_at_ = clock_.Now();
  BeginToMeasure(started_at_);
  const Time settled_at = started_at_ + DurationFromSeconds(options_.settle_seconds);
  const Time end_at =
      options_.seconds > 0.0 ? started_at_ + DurationFromSeconds(options_.seconds) : Time::max();
  while (clock_.Now() < end_at && !processes_.gateway_finished()) {
    const Duration left = end_at - clock_.Now();
    if (stop_signal_.WaitFor(std::clamp<Duration>(left, Duration::zero(), kLook))) {
      break;
    }
    if (Status alive = processes_.Supervise(); !alive) {
      return alive;
    }
    const Time now = clock_.Now();
    if (measured_from_ < settled_at && now >= settled_at) {
      BeginToMeasure(now);
    }
    if (StandsAtFirst(options_)) {
      AskReferencePose(now);
    }
    CountErrorsFromWhenItFits();
    ShowProgress(now);
  }
  return Ok();
}

void Demo::BeginToMeasure(Time now) {
  measured_from_ = now;
  client_cpu_at_start_s_ = runtime::ReadProcessUsage().cpu_seconds;
  host_at_start_ = runtime::ReadHostUsage();
  view_->With([](PipelineModel& model) { model.Mark(); });
}

void Demo::AskReferencePose(Time now) {
  const double stand_s = options_.seconds > 0.0
                             ? std::min(kStandBeforePose_s, options_.seconds / 2.0)
                             : kStandBeforePose_s;
  if (reference_pose_->accepted() || now - started_at_ < DurationFromSeconds(stand_s)) {
    return;
  }
  const auto bodies = view_->With([](const PipelineModel& model) {
    std::vector<BodyId> ids;
    ids.reserve(model.bodies.size());
    for (const auto& [id, body] : model.bodies) {
      ids.push_back(id);
    }
    return ids;
  });
  for (const BodyId id : bodies) {
    reference_pose_->Ask(id, now);
  }
}

// Segments can be compared with the truth once their sensors are aligned; sensors at once.
void Demo::CountErrorsFromWhenItFits() {
  if (counting_errors_ || (options_.recording.empty() && !reference_pose_->accepted())) {
    return;
  }
  counting_errors_ = true;
  view_->With([](PipelineModel& model) {
    Time newest{};
    for (const auto& [id, body] : model.bodies) {
      newest = std::max(newest, body.last.measured_at);
    }
    model.errors.CountFrom(newest + kSettle);
    model.positions.CountFrom(newest + kSettle);
  });
}

void Demo::ShowProgress(Time now) {
  if (options_.quiet || now < next_progress_) {
    return;
  }
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  next_progress_ = now + (terminal ? Duration(200ms) : Duration(2s));
  const std::string line = view_->With([&](const PipelineModel& model) {
    return ProgressLine(model, ToSeconds(now - started_at_));
  });
  if (terminal) {
    fmt::print("\r\033[K{}", line);
  } else {
    fmt::print("{}\n", line);
  }
  std::fflush(stdout);
}

void Demo::End() {
  ended_at_ = clock_.Now();
  client_cpu_seconds_ = runtime::ReadProcessUsage().cpu_seconds - client_cpu_at_start_s_;
  host_used_ = runtime::ReadHostUsage() - host_at_start_;
  ended_cleanly_ = true;
  runtime::Sleeper sleeper;
  // In the direction of the stream, each one after it has done what the one before has sent; the
  // last report of each has its final counters.
  for (const Part part : {Part::kGateway, Part::kFusion, Part::kPosture}) {
    const std::uint32_t pid = processes_.pid(part);
    if (pid == 0) {
      continue;  // a gateway that came to the end of its recording
    }
    const Time asked_at = clock_.Now();
    ended_cleanly_ = processes_.Stop(part) && ended_cleanly_;
    const auto reported = [&] {
      return view_->With(
          [&](const PipelineModel& model) { return model.health.HasReported(pid, asked_at); });
    };
    const Time deadline = clock_.Now() + 2s;
    while (!reported() && clock_.Now() < deadline) {
      [[maybe_unused]] const bool slept = sleeper.For(5ms);
    }
    if (!reported()) {
      without_last_report_.emplace_back(NameOf(part));
    }
    [[maybe_unused]] const bool slept = sleeper.For(100ms);  // what is under way arrives
  }
}

nlohmann::json Demo::SumUp() {
  DemoOutcome outcome;
  outcome.duration_s = ToSeconds(ended_at_ - measured_from_);
  outcome.restarts = processes_.restarts();
  outcome.child_cpu_seconds = processes_.cpu_seconds();
  outcome.client_cpu_seconds = client_cpu_seconds_;
  outcome.host_busy_seconds = host_used_.busy_seconds;
  outcome.host_stolen_seconds = host_used_.stolen_seconds;
  outcome.client_rss_mib = runtime::ReadProcessUsage().rss_mib;
  outcome.without_last_report = without_last_report_;
  outcome.reference_pose = reference_pose_->message();
  outcome.clean_exit = ended_cleanly_ && processes_.clean() && processes_.leftovers() == 0;
  ended_cleanly_ = outcome.clean_exit;
  return view_->With(
      [&](const PipelineModel& model) { return SummaryJson(options_, model, outcome); });
}

}  // namespace limbcast::tool
