#include "tools/limbcast/calibrate/body_guide.hpp"

#include <fmt/format.h>

#include <cmath>

namespace limbcast::tool {
namespace {

constexpr int kAttempts = 4;
constexpr double kAgain_s = 2.0;

Error GivenUp() { return Error{ErrorCode::kUnavailable, "given up; nothing was changed since"}; }

bool CountDown(const BodyGuide& guide, double seconds, const std::string& until) {
  for (int left = static_cast<int>(std::ceil(seconds)); left > 0; --left) {
    if (left <= 5 || left % 5 == 0) {
      guide.say(fmt::format("{} in {} s", until, left));
    }
    if (!guide.wait(1.0)) {
      return false;
    }
  }
  return true;
}

Result<std::string> Asked(const BodyGuide& guide, roster::CommandKind kind, const std::string& text,
                          const std::vector<double>& numbers = {}) {
  const auto reply = guide.ask(kind, text, numbers);
  if (!reply) {
    return reply.error();
  }
  if (!reply->accepted) {
    return Error{ErrorCode::kInvalidArgument, reply->message};
  }
  return reply->message;
}

Result<std::string> Stand(const BodyGuide& guide, const BodyGuideOptions& options) {
  guide.say(options.pose == "t_pose"
                ? "Stand upright and still, arms straight out to the sides, palms down."
                : "Stand upright and still, arms hanging, palms inwards, feet and eyes ahead.");
  if (!CountDown(guide, options.countdown_s, "reference pose")) {
    return GivenUp();
  }
  std::vector<double> facing;
  if (options.facing_rad) {
    facing.push_back(*options.facing_rad);
  }
  for (int attempt = 1;; ++attempt) {
    auto posed = Asked(guide, roster::CommandKind::kReferencePose, options.pose, facing);
    if (posed || posed.error().code != ErrorCode::kInvalidArgument || attempt == kAttempts) {
      return posed;
    }
    guide.say("not yet: " + posed.error().message);
    if (!guide.wait(kAgain_s)) {
      return GivenUp();
    }
  }
}

Result<std::string> Walk(const BodyGuide& guide, const BodyGuideOptions& options) {
  if (auto started = Asked(guide, roster::CommandKind::kFunctionalCalibration, "start"); !started) {
    return started;
  }
  guide.say(
      "Walk, as you always do, arms free. Straight on as far as there is room; turn and go on.");
  const bool walked = CountDown(guide, options.walk_s, "enough");
  auto finished =
      Asked(guide, roster::CommandKind::kFunctionalCalibration, walked ? "finish" : "cancel");
  if (walked && finished) {
    return finished;
  }
  // A reference pose alone aligns sensors without magnetometer wrongly: better the old one.
  (void)Asked(guide, roster::CommandKind::kUndo, "");
  return walked ? finished : Result<std::string>(GivenUp());
}

}  // namespace

Result<std::string> GuideBody(const BodyGuide& guide, const BodyGuideOptions& options) {
  auto done = Stand(guide, options);
  if (done && options.walk_s > 0.0) {
    guide.say(*done);
    done = Walk(guide, options);
  }
  if (!done || options.profile.empty()) {
    return done;
  }
  guide.say(*done);
  auto saved = Asked(guide, roster::CommandKind::kProfile, "save " + options.profile);
  if (!saved) {
    return Error{saved.error().code, "the alignment is in force, but profile " + options.profile +
                                         " was not saved: " + saved.error().message};
  }
  return saved;
}

}  // namespace limbcast::tool
