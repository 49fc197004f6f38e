#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/base/time.hpp"
#include "common/base/tracking.hpp"
#include "common/base/verdict.hpp"
#include "common/body/skeleton.hpp"
#include "common/body/stage_times.hpp"

namespace limbcast::tool {

/// JSON has no NaN and no infinity: they become null.
[[nodiscard]] inline nlohmann::json NumberToJson(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

[[nodiscard]] inline nlohmann::json TimeToJson(Time time) { return ToNanoseconds(time); }

template <typename Derived>
[[nodiscard]] nlohmann::json VectorToJson(const Eigen::MatrixBase<Derived>& vector) {
  nlohmann::json list = nlohmann::json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    list.push_back(NumberToJson(static_cast<double>(vector(i))));
  }
  return list;
}

/// Row by row.
template <typename Derived>
[[nodiscard]] nlohmann::json MatrixToJson(const Eigen::MatrixBase<Derived>& matrix) {
  nlohmann::json rows = nlohmann::json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.push_back(VectorToJson(matrix.row(i)));
  }
  return rows;
}

/// [w, x, y, z].
template <typename Scalar>
[[nodiscard]] nlohmann::json QuaternionToJson(const Eigen::Quaternion<Scalar>& q) {
  return {NumberToJson(static_cast<double>(q.w())), NumberToJson(static_cast<double>(q.x())),
          NumberToJson(static_cast<double>(q.y())), NumberToJson(static_cast<double>(q.z()))};
}

/// Counters that are not zero, by the name of the verdict.
[[nodiscard]] nlohmann::json VerdictsToJson(const VerdictCounters& verdicts);
[[nodiscard]] nlohmann::json StagesToJson(const body::StageTimes& stages);
[[nodiscard]] std::string_view NameOf(MagneticState state);
[[nodiscard]] std::string_view NameOf(HeadingReference heading);
[[nodiscard]] std::string_view NameOf(body::SegmentStatus status);

}  // namespace limbcast::tool
