#include "tools/limbcast/calibrate/live_collector.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/inproc/inproc_bus.hpp"
#include "tests/unit/common/sensing/calibration_scene.hpp"

namespace limbcast::tool {
namespace {

using ::testing::HasSubstr;

class LiveCollectorTest : public ::testing::Test {
 protected:
  void Publish(const std::string& calibration) {
    roster::RosterEntry person;
    person.body_id = BodyId{1};
    person.sensors = {{SensorUid{1}, body::Segment::kHead}};
    ASSERT_TRUE(roster_writer_->Write(person).ok());
    roster_writer_->Flush();
    sensing::SensorInfo info;
    info.sensor_uid = SensorUid{1};
    info.serial = "00A";
    info.label = "pelvis";
    info.calibration = calibration;
    ASSERT_TRUE(info_writer_->Write(info).ok());
    for (const sensing::MargSample& sample : samples_) {
      ASSERT_TRUE(marg_writer_->Write(sample).ok());
    }
    info_writer_->Flush();
    marg_writer_->Flush();
  }

  const std::vector<sensing::MargSample> samples_ =
      sensing::scene::Read(sensing::scene::RandomPoses(2, 1), {}, 1);
  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(bus::inproc::MakeHub());
  std::unique_ptr<bus::Writer<sensing::SensorInfo>> info_writer_ =
      *bus_->MakeWriter<sensing::SensorInfo>();
  std::unique_ptr<bus::Writer<roster::RosterEntry>> roster_writer_ =
      *bus_->MakeWriter<roster::RosterEntry>();
  std::unique_ptr<bus::Writer<sensing::MargSample>> marg_writer_ =
      *bus_->MakeWriter<sensing::MargSample>();
};

TEST_F(LiveCollectorTest, CollectsWhatAGatewaySends) {
  const auto collector = LiveCollector::Make(*bus_, "pelvis");
  ASSERT_TRUE(collector.ok());
  EXPECT_THAT((*collector)->Line(), HasSubstr("waiting for sensor pelvis"));
  EXPECT_EQ((*collector)->Take(true).error().code, ErrorCode::kNotFound);
  Publish("");
  EXPECT_THAT((*collector)->Line(), HasSubstr("2 poses"));
  EXPECT_FALSE((*collector)->complete());
  const auto taken = (*collector)->Take(true);
  ASSERT_TRUE(taken.ok()) << taken.error().message;
  EXPECT_EQ(taken->front().samples.size(), samples_.size());
  EXPECT_EQ(taken->front().Name(), "pelvis (00A) on head");
}

TEST_F(LiveCollectorTest, CorrectedReadingsAreRefusedWhereRawOnesAreNeeded) {
  const auto collector = LiveCollector::Make(*bus_, "");
  ASSERT_TRUE(collector.ok());
  Publish("accel good");
  EXPECT_EQ((*collector)->Take(true).error().message,
            "pelvis (00A) on head is corrected already (accel good): start the gateway with "
            "gateway.calibration_folder=\"\"");
  EXPECT_TRUE((*collector)->Take(false).ok());
}

}  // namespace
}  // namespace limbcast::tool
