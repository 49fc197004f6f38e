#include "services/gateway/sample_publisher.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/bus/inproc/inproc_bus.hpp"
#include "tests/support/fake_clock.hpp"
#include "tests/unit/services/gateway/fake_driver.hpp"
#include "tests/unit/services/gateway/fake_pipeline.hpp"

namespace limbcast::gateway {
namespace {

class SamplePublisherTest : public ::testing::Test {
 protected:
  std::unique_ptr<SamplePublisher> Make(const DriverDescription& description) {
    auto made = SamplePublisher::Make(config_, description, clock_, *bus_);
    Expects(made.ok(), "a publisher");
    return std::move(*made);
  }
  void Publish(SamplePublisher& publisher, Batch batch) {
    publisher.Stamp(batch);
    publisher.Write(batch);
  }

  GatewayConfig config_;
  test_support::FakeClock clock_;
  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(bus::inproc::MakeHub());
  test::FakePipeline pipeline_{*bus_};
  test::FakeDriver driver_{2, 3};
};

Batch OneSample(SensorUid uid, const sensing::MargSample& values) {
  Batch batch;
  batch.marg.push_back(values);
  batch.marg.back().sensor_uid = uid;
  return batch;
}

TEST_F(SamplePublisherTest, NumbersEachSensorsSamplesFromOne) {
  const auto publisher = Make(driver_.Describe());
  Batch batch;
  for (int tick = 0; tick < 3; ++tick) {
    ASSERT_TRUE(driver_.Next(batch).ok());
    Publish(*publisher, batch);
  }
  for (const std::uint64_t uid : {1U, 2U}) {
    const auto samples = pipeline_.Of(SensorUid{uid});
    ASSERT_EQ(samples.size(), 3U);
    for (std::uint32_t i = 0; i < 3; ++i) {
      EXPECT_EQ(samples[i].sequence, i + 1);
      EXPECT_EQ(samples[i].published_at, clock_.Now());
    }
  }
}

TEST_F(SamplePublisherTest, SaturationIsFlaggedFromNinetyNinePercentOn) {
  driver_.description().sensors[0].gyro_range_rad_s = 10.0F;
  driver_.description().sensors[0].accel_range_m_s2 = 100.0F;
  driver_.description().sensors[0].mag_range_tesla = 1e-4F;
  const auto publisher = Make(driver_.Describe());
  sensing::MargSample sample;
  sample.gyro_rad_s.x() = 9.89F;
  Publish(*publisher, OneSample(SensorUid{1}, sample));
  sample.gyro_rad_s.x() = -9.91F;
  Publish(*publisher, OneSample(SensorUid{1}, sample));
  sample.gyro_rad_s.x() = 0.0F;
  sample.accel_m_s2.z() = 99.5F;
  sample.mag_tesla.y() = 1e-4F;
  Publish(*publisher, OneSample(SensorUid{1}, sample));
  sample.flags = sensing::kMagMissing;
  Publish(*publisher, OneSample(SensorUid{1}, sample));

  ASSERT_EQ(pipeline_.samples.size(), 4U);
  EXPECT_EQ(pipeline_.samples[0].flags, 0U);
  EXPECT_EQ(pipeline_.samples[1].flags, sensing::kGyroSaturated);
  EXPECT_EQ(pipeline_.samples[2].flags, sensing::kAccelSaturated | sensing::kMagSaturated);
  EXPECT_EQ(pipeline_.samples[3].flags, sensing::kAccelSaturated | sensing::kMagMissing);
  EXPECT_EQ(publisher->counters().saturated, 3U);
}

TEST_F(SamplePublisherTest, UnknownRangeNeverSaturates) {
  const auto publisher = Make(driver_.Describe());
  sensing::MargSample sample;
  sample.gyro_rad_s.x() = 1e9F;
  Publish(*publisher, OneSample(SensorUid{1}, sample));
  EXPECT_EQ(pipeline_.samples[0].flags, 0U);
}

TEST_F(SamplePublisherTest, NotFiniteReadingsGoThroughUntouched) {
  driver_.description().sensors[0].gyro_range_rad_s = 10.0F;
  const auto publisher = Make(driver_.Describe());
  sensing::MargSample sample;
  sample.gyro_rad_s.x() = std::nanf("");
  sample.accel_m_s2.x() = std::numeric_limits<float>::infinity();
  Publish(*publisher, OneSample(SensorUid{1}, sample));
  EXPECT_TRUE(std::isnan(pipeline_.samples[0].gyro_rad_s.x()));
  EXPECT_TRUE(std::isinf(pipeline_.samples[0].accel_m_s2.x()));
  EXPECT_EQ(pipeline_.samples[0].flags, 0U);
}

TEST_F(SamplePublisherTest, FramesCarryAllSensorsOfABody) {
  config_.marg_frame = true;
  sensing::SensorInfo loose;
  loose.sensor_uid = SensorUid{77};
  driver_.description().sensors.push_back(loose);
  const auto publisher = Make(driver_.Describe());
  Batch batch;
  ASSERT_TRUE(driver_.Next(batch).ok());
  Publish(*publisher, batch);
  EXPECT_EQ(pipeline_.frames, 1);
  EXPECT_EQ(pipeline_.frame_bodies.front(), BodyId{1});
  EXPECT_EQ(pipeline_.samples.size(), 3U);  // the one that nobody wears came by itself
}

TEST_F(SamplePublisherTest, AFrameNeverHoldsMoreThanItsBound) {
  config_.marg_frame = true;
  const auto publisher = Make(driver_.Describe());
  Batch batch;
  for (std::size_t i = 0; i < sensing::kMaxSamplesPerFrame + 1; ++i) {
    batch.marg.emplace_back();
    batch.marg.back().sensor_uid = SensorUid{1};
  }
  Publish(*publisher, batch);
  EXPECT_EQ(pipeline_.frames, 2);
  EXPECT_EQ(pipeline_.samples.size(), sensing::kMaxSamplesPerFrame + 1);
  EXPECT_EQ(publisher->counters().write_errors, 0U);
}

TEST_F(SamplePublisherTest, AnnouncesSensorsAndPeopleAndTakesSensorsBack) {
  const auto publisher = Make(driver_.Describe());
  ASSERT_TRUE(publisher->Announce(driver_.Describe()).ok());
  EXPECT_EQ(pipeline_.infos.size(), 2U);
  ASSERT_EQ(pipeline_.entries.size(), 1U);
  EXPECT_EQ(pipeline_.entries[0].sensors.size(), 2U);
  publisher->Withdraw(driver_.Describe());
  EXPECT_EQ(pipeline_.infos_disposed, 2);
}

TEST_F(SamplePublisherTest, RosterIsLeftToTheSessionHostIfToldSo) {
  config_.publish_roster = false;
  const auto publisher = Make(driver_.Describe());
  ASSERT_TRUE(publisher->Announce(driver_.Describe()).ok());
  EXPECT_TRUE(pipeline_.entries.empty());
}

TEST_F(SamplePublisherTest, ProbesAskForEveryWornSensorAndClaimNothing) {
  const auto publisher = Make(driver_.Describe());
  publisher->WriteProbes(clock_.Now());
  ASSERT_EQ(pipeline_.probes.size(), 2U);
  EXPECT_EQ(pipeline_.probes[0].sequence, 0U);
  EXPECT_EQ(pipeline_.probes[0].flags, sensing::kProbe | sensing::kGyroMissing |
                                           sensing::kAccelMissing | sensing::kMagMissing |
                                           sensing::kTemperatureMissing);
  EXPECT_EQ(pipeline_.probes[0].measured_at, clock_.Now());
}

TEST_F(SamplePublisherTest, MarkersGoBeforeTheSamplesAndCoilBurstsAfterThem) {
  const auto publisher = Make(driver_.Describe());
  Batch batch;
  ASSERT_TRUE(driver_.Next(batch).ok());
  batch.markers.resize(2);
  batch.markers[1].marker = 7;
  batch.coil_bursts.resize(1);
  batch.coil_bursts[0].sensor_uid = SensorUid{2};
  Publish(*publisher, batch);
  ASSERT_EQ(pipeline_.markers.size(), 2U);
  EXPECT_EQ(pipeline_.samples_before_marker, (std::vector<std::size_t>{0, 0}));
  EXPECT_EQ(pipeline_.markers[1].marker, 7U);
  EXPECT_EQ(pipeline_.markers[1].published_at, clock_.Now());
  ASSERT_EQ(pipeline_.bursts.size(), 1U);
  EXPECT_EQ(pipeline_.bursts[0].sensor_uid, SensorUid{2});
  EXPECT_EQ(pipeline_.bursts[0].published_at, clock_.Now());
  EXPECT_EQ(publisher->counters().markers, 2U);
  EXPECT_EQ(publisher->counters().coil_bursts, 1U);
}

TEST_F(SamplePublisherTest, TruthIsLeftOutIfToldSo) {
  driver_.with_truth = true;
  config_.publish_truth = false;
  const auto publisher = Make(driver_.Describe());
  Batch batch;
  ASSERT_TRUE(driver_.Next(batch).ok());
  Publish(*publisher, batch);
  EXPECT_TRUE(pipeline_.truths.empty());
  EXPECT_EQ(publisher->counters().truth, 0U);
}

}  // namespace
}  // namespace limbcast::gateway
