#pragma once

#include <Eigen/Core>
#include <span>
#include <string_view>

#include "common/base/result.hpp"
#include "common/sensing/sensor_calibration.hpp"

namespace limbcast::sensing {

/// When an ellipsoid fit is refused, and how it treats outliers.
struct EllipsoidConfig {
  /// Length that the corrected vectors must have (g, the local field), in the unit of the readings.
  /// 0: not known; then the determinant of M is 1, i.e. the sensor keeps its overall scale.
  double norm = 0.0;
  /// Readings further than this many RMS residuals out are weighted down (Huber). Range: [1, 100].
  double huber_sigmas = 2.5;
  /// Refused when 1-sigma of an element of M is more. Range: (0, 1].
  double max_sigma = 0.003;
  /// Refused when the RMS residual |y|/norm − 1 after the fit is more. Range: (0, 1].
  double max_residual = 0.05;
  /// Refused when less of the sphere has been seen. Range: (0, 1].
  double min_coverage = 0.7;
};

/// Fits M (symmetric) and b so that |M (r − b)| is the same for all readings r of a vector of
/// constant length seen from many directions: gravity at rest, or the earth field.
///
/// Starts with the algebraic quadric (Li & Griffiths, "Least squares ellipsoid specific fitting",
/// GMP 2004, without the constraint; Merayo et al., "Scalar calibration of vector magnetometers",
/// Meas. Sci. Technol. 11 (2000)) and goes on with Gauss–Newton on the residual |M(r−b)| − 1, which
/// is the maximum likelihood fit for even noise (Vasconcelos et al. 2011, Eq. (13)).
///
/// A rotation of all corrected vectors cannot be seen in their lengths. M is symmetric: of all
/// matrices that fit it turns the axes least.
///
/// kInvalidArgument says what is missing: readings, directions (in `words_of_position`, e.g. "+z
/// up" for " up"), or constancy of the field.
[[nodiscard]] Result<TriadFit> FitEllipsoid(std::span<const Eigen::Vector3d> readings,
                                            const EllipsoidConfig& config,
                                            std::string_view words_of_position);

/// RMS of |M(r − b)|/norm − 1, with `norm` 0 replaced by the mean length.
[[nodiscard]] double LengthResidual(std::span<const Eigen::Vector3d> readings,
                                    const TriadCalibration& calibration, double norm);

}  // namespace limbcast::sensing
