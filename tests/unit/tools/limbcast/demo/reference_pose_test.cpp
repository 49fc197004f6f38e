#include "tools/limbcast/demo/reference_pose.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "common/bus/bus_factory.hpp"

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;

class ReferencePoseTest : public ::testing::Test {
 protected:
  ReferencePoseTest() {
    bus::BusConfig config;
    config.vendor = bus::Vendor::kInproc;
    config.partition = "reference_pose_test";
    bus_ = bus::Open(config).value();
    commands_ =
        bus_->MakeReader<roster::Command>(
                {.on_sample = [this](const roster::Command& command,
                                     const bus::SampleInfo&) { received_.push_back(command); },
                 .on_disposed = {}})
            .value();
    replies_ = bus_->MakeWriter<roster::CommandReply>().value();
    pose_ = ReferencePose::Make(*bus_).value();
  }

  void Reply(const roster::Command& to, bool accepted, const std::string& message) {
    roster::CommandReply reply;
    reply.client_uid = to.client_uid;
    reply.request_id = to.request_id;
    reply.accepted = accepted;
    reply.message = message;
    ASSERT_TRUE(replies_->Write(reply).ok());
  }

  std::unique_ptr<bus::Bus> bus_;
  std::vector<roster::Command> received_;
  std::unique_ptr<bus::Reader<roster::Command>> commands_;
  std::unique_ptr<bus::Writer<roster::CommandReply>> replies_;
  std::unique_ptr<ReferencePose> pose_;
};

constexpr Time kNow = TimeFromNanoseconds(1'700'000'000'000'000'000);

TEST_F(ReferencePoseTest, AsksAgainUntilItIsAccepted) {
  pose_->Ask(BodyId{3}, kNow);
  ASSERT_EQ(received_.size(), 1U);
  EXPECT_EQ(received_[0].kind, roster::CommandKind::kReferencePose);
  EXPECT_EQ(received_[0].body_id, BodyId{3});

  Reply(received_[0], false, "moving");
  EXPECT_EQ(pose_->message(), "moving");
  EXPECT_FALSE(pose_->accepted());
  pose_->Ask(BodyId{3}, kNow + 100ms);  // too soon
  EXPECT_EQ(received_.size(), 1U);
  pose_->Ask(BodyId{3}, kNow + 400ms);
  ASSERT_EQ(received_.size(), 2U);
  EXPECT_NE(received_[0].request_id, received_[1].request_id);

  Reply(received_[1], true, "aligned");
  EXPECT_TRUE(pose_->accepted());
  pose_->Ask(BodyId{3}, kNow + 5s);
  EXPECT_EQ(received_.size(), 2U);
}

TEST_F(ReferencePoseTest, EachBodyIsAskedUntilItsOwnPoseIsTaken) {
  pose_->Ask(BodyId{1}, kNow);
  pose_->Ask(BodyId{2}, kNow);
  ASSERT_EQ(received_.size(), 2U);
  Reply(received_[1], true, "aligned");
  EXPECT_FALSE(pose_->accepted());
  pose_->Ask(BodyId{1}, kNow + 1s);
  pose_->Ask(BodyId{2}, kNow + 1s);  // has it
  ASSERT_EQ(received_.size(), 3U);
  EXPECT_EQ(received_[2].body_id, BodyId{1});
  Reply(received_[2], true, "aligned");
  EXPECT_TRUE(pose_->accepted());
}

TEST_F(ReferencePoseTest, AnswersToOthersAreNotOurs) {
  pose_->Ask(BodyId{3}, kNow);
  roster::Command of_another = received_.at(0);
  ++of_another.client_uid;
  Reply(of_another, true, "aligned");
  EXPECT_FALSE(pose_->accepted());
  EXPECT_EQ(pose_->message(), "");
}

}  // namespace
}  // namespace limbcast::tool
