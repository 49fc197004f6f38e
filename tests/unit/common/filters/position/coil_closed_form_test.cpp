#include "common/filters/position/coil_closed_form.hpp"

#include <gtest/gtest.h>

#include <array>

#include "common/math/rotation.hpp"

namespace limbcast::filters {
namespace {

const Eigen::Vector3d kPlace(0.1, -0.25, 0.3);
const Eigen::Matrix3d kPsi = math::ExpSO3({0.4, -1.1, 0.7}).toRotationMatrix();

std::array<CoilObservation, 3> DipolePulses(const sensing::CoilSource& source) {
  std::array<CoilObservation, 3> pulses;
  for (int c = 0; c < 3; ++c) {
    CoilObservation& o = pulses[static_cast<std::size_t>(c)];
    o.coil = c;
    o.current_a = c == 1 ? -1.5 : 1.0;
    o.sigma_tesla = 1e-15;
    o.field_tesla =
        kPsi * sensing::DipoleField_tesla(
                   o.current_a * source.MomentPerAmpere(c) * Eigen::Vector3d::Unit(c), kPlace);
  }
  return pulses;
}

TEST(CoilClosedFormTest, IsExactForDipolesUpToTheSign) {
  const sensing::CoilSource source;
  const auto start = CoilClosedForm(source, DipolePulses(source));
  ASSERT_TRUE(start);
  EXPECT_LT(start->p_emitter_sensor_m.cross(kPlace).norm(), 1e-12);
  EXPECT_NEAR(start->p_emitter_sensor_m.norm(), kPlace.norm(), 1e-9);
  EXPECT_LT((start->R_sensor_emitter - kPsi).norm(), 1e-10);
}

TEST(CoilClosedFormTest, TurnsPulsesIntoTheAxesOfTheReferenceTime) {
  const sensing::CoilSource source;
  auto pulses = DipolePulses(source);
  for (CoilObservation& o : pulses) {
    o.R_pulse_reference_sensor = math::ExpSO3({0.1 * o.coil, 0.2, -0.1}).toRotationMatrix();
    o.field_tesla = o.R_pulse_reference_sensor * o.field_tesla;
  }
  const auto start = CoilClosedForm(source, pulses);
  ASSERT_TRUE(start);
  EXPECT_LT((start->R_sensor_emitter - kPsi).norm(), 1e-10);
}

TEST(CoilClosedFormTest, NeedsASignalOfEveryCoil) {
  const sensing::CoilSource source;
  auto pulses = DipolePulses(source);
  pulses[2].coil = 0;
  EXPECT_FALSE(CoilClosedForm(source, pulses));
  for (CoilObservation& o : pulses) {
    o.field_tesla.setZero();
  }
  pulses[2].coil = 2;
  EXPECT_FALSE(CoilClosedForm(source, pulses));
}

TEST(ProcrustesRotationTest, GivesARotationForAReflection) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
  const Eigen::Matrix3d R = ProcrustesRotation(mirror, Eigen::Matrix3d::Identity());
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_GT(R.col(0).cross(R.col(1)).dot(R.col(2)), 0.0);
}

}  // namespace
}  // namespace limbcast::filters
