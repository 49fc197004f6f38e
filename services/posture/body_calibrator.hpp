#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/body/body_definition.hpp"
#include "common/body/functional_alignment.hpp"
#include "services/posture/motion_log.hpp"
#include "services/posture/tick_assembler.hpp"

namespace limbcast::posture {

/// What came of a functional calibration.
struct CalibrationOutcome {
  body::FunctionalFit fit;
  std::vector<body::Segment> left_out;  ///< tracked, but not heard all the time
};

/// Collects what a functional calibration needs while states pass by, and makes it: by command
/// (reference pose, start, finish), or by itself once it has seen a stance and then walking.
/// Thread-compatible. Allocates; the tracker calls it only while a calibration is wanted.
class BodyCalibrator {
 public:
  /// The walk that is enough for the automatic calibration, s.
  static constexpr double kAutomaticWalk_s = 15.0;

  void Add(body::Segment segment, Time measured_at, const Eigen::Quaterniond& q_earth_sensor,
           const Eigen::Vector3f& free_accel_in_earth_m_s2);

  /// The person stood in the reference pose at `at`.
  void NoteStance(const body::StandingPose& pose, Time at);

  /// The walk begins now; refuses without a stance.
  [[nodiscard]] Status Start(Time at);
  [[nodiscard]] bool started() const { return started_at_.has_value(); }
  void Cancel() { started_at_.reset(); }
  /// The walk is over. Ends the calibration in either case but too short a walk, which goes on.
  [[nodiscard]] Result<CalibrationOutcome> Finish(SegmentSet tracked, double facing_rad,
                                                  bool common_heading);

  /// Looks, now and then, for a stance and for walking; gives a calibration as soon as the latter
  /// supports one. Sitting down in between does not matter: of all still moments the first counts
  /// in which trunk and legs were inclined as while walking.
  [[nodiscard]] std::optional<CalibrationOutcome> Automatic(SegmentSet tracked,
                                                            bool common_heading);

  /// The still moment that lasts now, if one does: for heading resets by themselves.
  [[nodiscard]] const std::optional<body::StandingPose>& still_now() const { return still_now_; }
  void LookForStillness(SegmentSet tracked);

  /// How headings of arms are turned against the trunk's, by the last kSurvey_s of walking.
  struct HeadingError {
    body::Segment segment;
    double error_rad;
    double sigma_rad;
  };
  static constexpr double kSurvey_s = 12.0;
  [[nodiscard]] std::vector<HeadingError> SurveyArms(
      SegmentSet tracked, const body::PerSegment<double>& heading_correction_rad) const;

  void Clear();

 private:
  struct Still {
    body::StandingPose pose;
    Time at{};
    double spread_rad = 0.0;
  };
  [[nodiscard]] Result<CalibrationOutcome> Fit(const body::StandingPose& stance,
                                               body::MotionRecord walking, SegmentSet tracked,
                                               double facing_rad, bool common_heading) const;

  MotionLog log_;
  std::optional<body::StandingPose> stance_;
  std::optional<Time> started_at_;
  std::vector<Still> stills_;
  std::optional<body::StandingPose> still_now_;
  Time looked_at_{};
  Time tried_at_{};
};

/// Puts a fit into a definition: offsets, headings, `aligned` where there is no doubt. Says what
/// was done, for people.
[[nodiscard]] std::string ApplyFit(const CalibrationOutcome& outcome,
                                   body::BodyDefinition& definition);

}  // namespace limbcast::posture
