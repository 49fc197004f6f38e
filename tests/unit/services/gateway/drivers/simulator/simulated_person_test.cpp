#include "services/gateway/drivers/simulator/simulated_person.hpp"

#include <gtest/gtest.h>

#include <set>

#include "common/math/rotation.hpp"

namespace limbcast::gateway {
namespace {

SimulatorConfig Ideal() {
  SimulatorConfig config;
  config.noise = simulation::NoisePreset::kIdeal;
  config.iron = false;
  return config;
}

TEST(SimulatedPersonTest, SamplesAndTruthBelongTogether) {
  auto person = *SimulatedPerson::Make(Ideal(), 0);
  Batch batch;
  person.Next(TimeFromNanoseconds(2'000'000'000), 2.0, batch);
  ASSERT_EQ(batch.marg.size(), 17U);
  ASSERT_EQ(batch.truth.size(), 17U);
  const Eigen::Vector3d north_tesla = simulation::EarthField_tesla({});
  for (std::size_t i = 0; i < batch.marg.size(); ++i) {
    const auto& sample = batch.marg[i];
    const auto& truth = batch.truth[i];
    EXPECT_EQ(sample.sensor_uid, truth.sensor_uid);
    EXPECT_EQ(sample.measured_at, truth.measured_at);
    EXPECT_TRUE(truth.sensor_valid && truth.segment_valid);
    EXPECT_GE(truth.q_earth_sensor.w(), 0.0);
    // Standing still: gravity and north are where the true orientation says.
    const Eigen::Vector3d up = truth.q_earth_sensor * sample.accel_m_s2.cast<double>();
    const Eigen::Vector3d field = truth.q_earth_sensor * sample.mag_tesla.cast<double>();
    EXPECT_LT((up - 9.80665 * Eigen::Vector3d::UnitZ()).norm(), 1e-5);
    EXPECT_LT((field - north_tesla).norm(), 1e-10);
  }
}

TEST(SimulatedPersonTest, SegmentTruthIsTheSensorTruthWithoutItsMounting) {
  SimulatorConfig config = Ideal();
  config.mounting = simulation::MountingStyle::kAligned;
  auto person = *SimulatedPerson::Make(config, 0);
  Batch batch;
  person.Next(Time{}, 9.5, batch);
  for (const auto& truth : batch.truth) {
    EXPECT_LT(math::AngleBetween_rad(truth.q_earth_sensor, truth.q_earth_segment), 1e-7);
  }
}

TEST(SimulatedPersonTest, PeopleDiffer) {
  const SimulatorConfig config = [] {
    SimulatorConfig two = Ideal();
    two.persons = 2;
    return two;
  }();
  auto first = *SimulatedPerson::Make(config, 0);
  auto second = *SimulatedPerson::Make(config, 1);
  EXPECT_EQ(second.roster_entry().body_id.value, 2U);
  std::set<std::uint64_t> uids;
  for (const auto* person : {&first, &second}) {
    for (const auto& info : person->sensors()) {
      uids.insert(info.sensor_uid.value);
    }
  }
  EXPECT_EQ(uids.size(), 34U);
  const auto at = [](const SimulatedPerson& person) {
    return person.motion().At(0.0).segments[0].p_earth_local_m;
  };
  EXPECT_NEAR((at(first) - at(second)).norm(), config.spacing_m, 1e-9);
}

TEST(SimulatedPersonTest, WithoutMagnetometerItIsFlaggedNeverFaked) {
  SimulatorConfig config;
  config.magnetometer = false;
  auto person = *SimulatedPerson::Make(config, 0);
  Batch batch;
  person.Next(Time{}, 1.0, batch);
  for (const auto& sample : batch.marg) {
    EXPECT_TRUE(sample.Has(sensing::kMagMissing));
    EXPECT_TRUE(sample.mag_tesla.isZero());
  }
  EXPECT_EQ(person.sensors()[0].mag_range_tesla, 0.0F);
}

}  // namespace
}  // namespace limbcast::gateway
