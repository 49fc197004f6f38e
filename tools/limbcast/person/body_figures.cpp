#include "tools/limbcast/person/body_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "common/body/joint_angles.hpp"
#include "common/math/rotation.hpp"
#include "common/units/units.hpp"

namespace limbcast::tool {
namespace {

using body::Segment;

constexpr std::array<std::pair<const char*, int>, 2> kSides = {{{"right", 0}, {"left", 1}}};
constexpr double kAnything = 180.0;

struct Leg {
  Segment thigh;
  Segment shank;
  body::Joint hip;
  body::Joint knee;
  body::Joint ankle;
};
Leg LegOf(int side) {
  return side == 0 ? Leg{Segment::kRightUpperLeg, Segment::kRightLowerLeg, body::Joint::kRightHip,
                         body::Joint::kRightKnee, body::Joint::kRightAnkle}
                   : Leg{Segment::kLeftUpperLeg, Segment::kLeftLowerLeg, body::Joint::kLeftHip,
                         body::Joint::kLeftKnee, body::Joint::kLeftAnkle};
}

std::vector<const BodyFrame*> In(const BodyTrace& trace, const TimeSpan& span) {
  std::vector<const BodyFrame*> frames;
  for (const BodyFrame& frame : trace.frames) {
    if (frame.time_s >= span.from_s && frame.time_s < span.to_s) {
      frames.push_back(&frame);
    }
  }
  return frames;
}

/// Known in nearly all of the frames: a lost sample is no reason to say nothing.
bool Known(const std::vector<const BodyFrame*>& frames, Segment segment) {
  const auto known = std::count_if(frames.begin(), frames.end(), [&](const BodyFrame* frame) {
    return frame->known[body::Index(segment)];
  });
  return !frames.empty() && static_cast<double>(known) > 0.9 * static_cast<double>(frames.size());
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value / static_cast<double>(values.size());
  }
  return sum;
}

double Rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value * value / static_cast<double>(values.size());
  }
  return std::sqrt(sum);
}

std::vector<double> Each(const std::vector<const BodyFrame*>& frames,
                         const std::function<double(const BodyFrame&)>& of_rad) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const BodyFrame* frame : frames) {
    values.push_back(units::DegFromRad(of_rad(*frame)));
  }
  return values;
}

std::vector<double> Angle(const std::vector<const BodyFrame*>& frames, body::Joint joint,
                          int which) {
  return Each(frames, [&](const BodyFrame& frame) { return JointAngle_rad(frame, joint, which); });
}

std::vector<double> ThighAboutTrunk(const std::vector<const BodyFrame*>& frames, const Leg& leg) {
  return Each(frames, [&](const BodyFrame& frame) {
    return body::AnglesOf(leg.hip, frame.q_earth_segment[body::Index(Segment::kT8)],
                          frame.q_earth_segment[body::Index(leg.thigh)])
        .angle_rad[0];
  });
}

/// Mean heading of a segment, by the axis to its left: bending does not turn it.
double Heading_deg(const std::vector<const BodyFrame*>& frames, Segment segment) {
  double s = 0.0;
  double c = 0.0;
  for (const BodyFrame* frame : frames) {
    const Eigen::Vector3d left =
        frame->q_earth_segment[body::Index(segment)] * Eigen::Vector3d::UnitY();
    s += -left.x();
    c += left.y();
  }
  return units::DegFromRad(std::atan2(s, c));
}

void Standing(const BodyTrace& trace, const TimeSpan& span, std::vector<BodyFigure>& figures) {
  const auto frames = In(trace, span);
  for (const Segment segment : body::AllSegments()) {
    if (Known(frames, segment)) {
      const auto tilt = Each(frames, [&](const BodyFrame& frame) {
        const Eigen::Vector3d up =
            frame.q_earth_segment[body::Index(segment)] * Eigen::Vector3d::UnitZ();
        return std::acos(std::clamp(up.z(), -1.0, 1.0));
      });
      figures.push_back({fmt::format("standing: {} from upright, most", body::ToString(segment)),
                         *std::max_element(tilt.begin(), tilt.end()), 0.0, 10.0});
    }
  }
}

void Sitting(const BodyTrace& trace, const TimeSpan& span, std::vector<BodyFigure>& figures) {
  const auto frames = In(trace, span);
  for (const auto& [name, side] : kSides) {
    const Leg leg = LegOf(side);
    if (Known(frames, leg.thigh) && Known(frames, Segment::kPelvis)) {
      figures.push_back({fmt::format("sitting: {} hip (thigh about pelvis)", name),
                         Mean(Angle(frames, leg.hip, 0)), -kAnything, kAnything});
    }
    if (Known(frames, leg.thigh) && Known(frames, Segment::kT8)) {
      figures.push_back({fmt::format("sitting: {} thigh about trunk", name),
                         Mean(ThighAboutTrunk(frames, leg)), 70.0, 110.0});
    }
    if (Known(frames, leg.thigh) && Known(frames, leg.shank)) {
      figures.push_back(
          {fmt::format("sitting: {} knee", name), Mean(Angle(frames, leg.knee, 0)), 70.0, 110.0});
    }
  }
}

void Knees(const std::vector<const BodyFrame*>& frames, const std::string& walk,
           std::vector<BodyFigure>& figures) {
  std::vector<double> means;
  for (const auto& [name, side] : kSides) {
    const Leg leg = LegOf(side);
    if (!Known(frames, leg.thigh) || !Known(frames, leg.shank)) {
      continue;
    }
    const std::vector<double> flexion = Angle(frames, leg.knee, 0);
    const double rate_hz =
        static_cast<double>(frames.size() - 1) / (frames.back()->time_s - frames.front()->time_s);
    const auto peaks = PeaksOf(flexion, 35.0, static_cast<std::size_t>(0.35 * rate_hz));
    double least_peak = kAnything;
    double most_peak = 0.0;
    double least_bent = -kAnything;  // of each stride its straightest moment; the worst of them
    for (std::size_t i = 0; i < peaks.size(); ++i) {
      least_peak = std::min(least_peak, flexion[peaks[i]]);
      most_peak = std::max(most_peak, flexion[peaks[i]]);
      if (i > 0) {
        least_bent =
            std::max(least_bent,
                     *std::min_element(flexion.begin() + static_cast<std::ptrdiff_t>(peaks[i - 1]),
                                       flexion.begin() + static_cast<std::ptrdiff_t>(peaks[i])));
      }
    }
    const std::string knee = fmt::format("{}: {} knee", walk, name);
    // A stride takes at most 2.2 s (gait.hpp), and the ends may cut one off.
    figures.push_back({knee + ", strides", static_cast<double>(peaks.size()),
                       std::floor((frames.back()->time_s - frames.front()->time_s) / 2.2) - 1.0,
                       1000.0});
    figures.push_back({knee + ", least peak of flexion", least_peak, 50.0, 85.0});
    figures.push_back({knee + ", greatest peak of flexion", most_peak, 50.0, 85.0});
    figures.push_back({knee + ", straightest moment of the worst stride", least_bent, -15.0, 15.0});
    figures.push_back({knee + ", out of the sagittal plane, rms of adduction",
                       Rms(Angle(frames, leg.knee, 1)), 0.0, 10.0});
    figures.push_back({knee + ", out of the sagittal plane, rms of rotation",
                       Rms(Angle(frames, leg.knee, 2)), 0.0, 10.0});
    means.push_back(Mean(flexion));
  }
  if (means.size() == 2) {
    figures.push_back({fmt::format("{}: knees, right mean less left mean", walk),
                       means[0] - means[1], -8.0, 8.0});
  }
}

/// Greatest correlation of an angle with itself one stride (0.7 to 2.2 s) later.
double Periodicity(const std::vector<const BodyFrame*>& frames, const std::vector<double>& angle) {
  const double rate_hz =
      static_cast<double>(frames.size() - 1) / (frames.back()->time_s - frames.front()->time_s);
  const double mean = Mean(angle);
  double best = -1.0;
  for (auto lag = static_cast<std::size_t>(0.7 * rate_hz);
       static_cast<double>(lag) < 2.2 * rate_hz && lag < angle.size() / 2; ++lag) {
    double ab = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    for (std::size_t i = 0; i + lag < angle.size(); ++i) {
      ab += (angle[i] - mean) * (angle[i + lag] - mean);
      aa += (angle[i] - mean) * (angle[i] - mean);
      bb += (angle[i + lag] - mean) * (angle[i + lag] - mean);
    }
    best = std::max(best, aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : -1.0);
  }
  return best;
}

/// Textbook ranges of a walk at a comfortable speed, with 2σ and room for how sensors sit: Winter
/// 1991, "The Biomechanics and Motor Control of Human Gait", joint angles at natural cadence.
void Ranges(const std::vector<const BodyFrame*>& frames, const std::string& walk,
            std::vector<BodyFigure>& figures) {
  for (const auto& [name, side] : kSides) {
    const Leg leg = LegOf(side);
    const auto add = [&](body::Joint joint, const char* what, bool most, double low, double high) {
      const body::JointSegments segments = body::SegmentsOf(joint);
      if (!Known(frames, *segments.parent) || !Known(frames, segments.child)) {
        return;
      }
      std::vector<double> angle = Angle(frames, joint, 0);
      std::sort(angle.begin(), angle.end());
      // 2 % from the end: one moment is no range.
      const auto at =
          static_cast<std::size_t>((most ? 0.98 : 0.02) * static_cast<double>(angle.size() - 1));
      figures.push_back({fmt::format("{}: {} {}", walk, name, what), angle[at], low, high});
    };
    for (const auto& [joint, what] :
         {std::pair{leg.hip, "hip"}, std::pair{leg.knee, "knee"}, std::pair{leg.ankle, "ankle"}}) {
      const body::JointSegments segments = body::SegmentsOf(joint);
      if (Known(frames, *segments.parent) && Known(frames, segments.child)) {
        figures.push_back(
            {fmt::format("{}: {} {}, likeness of a stride with the next", walk, name, what),
             Periodicity(frames, Angle(frames, joint, 0)), 0.5, 1.0});
      }
    }
    add(leg.hip, "hip, greatest flexion", true, 15.0, 55.0);
    add(leg.hip, "hip, greatest extension", false, -30.0, 5.0);
    add(leg.ankle, "ankle, greatest dorsiflexion", true, 0.0, 30.0);
    add(leg.ankle, "ankle, greatest plantarflexion", false, -40.0, -5.0);
  }
}

void Headings(const std::vector<const BodyFrame*>& frames, const std::string& walk,
              std::vector<BodyFigure>& figures) {
  double low = 0.0;
  double high = 0.0;
  double first = 0.0;
  bool any = false;
  for (const Segment segment : body::AllSegments()) {
    if (body::IsArm(segment) || !Known(frames, segment)) {
      continue;
    }
    const double heading = Heading_deg(frames, segment);
    first = any ? first : heading;
    const double off = std::remainder(heading - first, 360.0);
    low = std::min(low, off);
    high = std::max(high, off);
    any = true;
  }
  if (any) {
    figures.push_back(
        {walk + ": headings of trunk and legs, greatest difference", high - low, 0.0, 15.0});
  }
}

}  // namespace

std::vector<std::size_t> PeaksOf(const std::vector<double>& values, double least,
                                 std::size_t apart) {
  std::vector<std::size_t> peaks;
  // What is cut off by the ends is no peak.
  for (std::size_t i = apart; i + apart < values.size(); ++i) {
    const auto from = values.begin() + static_cast<std::ptrdiff_t>(i - apart);
    const auto to = values.begin() + static_cast<std::ptrdiff_t>(i + apart + 1);
    if (values[i] >= least &&
        std::max_element(from, to) == values.begin() + static_cast<std::ptrdiff_t>(i)) {
      peaks.push_back(i);
    }
  }
  return peaks;
}

std::vector<BodyFigure> BodyFigures(const BodyTrace& trace, const BodyPhases& phases) {
  std::vector<BodyFigure> figures;
  if (phases.standing) {
    Standing(trace, *phases.standing, figures);
  }
  if (phases.sitting) {
    Sitting(trace, *phases.sitting, figures);
  }
  for (std::size_t i = 0; i < phases.walks.size(); ++i) {
    const std::string walk = fmt::format("walk {}", i + 1);
    const auto frames = In(trace, phases.walks[i]);
    if (frames.size() < 2) {
      continue;
    }
    Knees(frames, walk, figures);
    Ranges(frames, walk, figures);
    Headings(frames, walk, figures);
  }
  for (std::size_t i = 1; i < phases.walks.size(); ++i) {
    const auto there = In(trace, phases.walks[i - 1]);
    const auto back = In(trace, phases.walks[i]);
    for (const Segment segment : body::AllSegments()) {
      if (Known(there, segment) && Known(back, segment)) {
        const double turned =
            std::remainder(Heading_deg(back, segment) - Heading_deg(there, segment), 360.0);
        figures.push_back(
            {fmt::format("walks {} and {}: {} turned by", i, i + 1, body::ToString(segment)),
             turned < 0.0 ? turned + 360.0 : turned, 168.0, 192.0});
      }
    }
  }
  return figures;
}

std::string FiguresText(const std::vector<BodyFigure>& figures) {
  std::string text;
  for (const BodyFigure& figure : figures) {
    const bool judged = figure.high < kAnything || figure.low > -kAnything;
    const std::string range =
        judged ? fmt::format("[{:.0f}, {:.0f}]", figure.low, figure.high) : "";
    text += fmt::format("{:5} {:<66} {:7.1f} {}\n",
                        !judged          ? ""
                        : figure.holds() ? "ok"
                                         : "NOT",
                        figure.name, figure.value, range);
  }
  return text;
}

}  // namespace limbcast::tool
