#include "services/gateway/gateway_session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/inproc/inproc_bus.hpp"

namespace limbcast::gateway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A host that gives body ids from 40 on, or refuses.
class GatewaySessionTest : public ::testing::Test {
 protected:
  GatewaySessionTest() {
    config_.session_host = true;
    config_.session = "stage";
    description_.source = "two people";
    description_.bodies.resize(2);
    description_.bodies[0].person = "first";
    description_.bodies[1].person = "second";
    description_.bodies[1].sensors = {{.sensor_uid = {5}, .segment = body::Segment::kHead}};
  }
  void StartHost() {
    replies_ = *bus_->MakeWriter<roster::JoinReply>();
    requests_ = *bus_->MakeReader<roster::JoinRequest>(
        {.on_sample =
             [this](const roster::JoinRequest& request, const bus::SampleInfo&) {
               const bool first = request.person == "first" || request.person == "Ada";
               heard_.push_back(request);
               roster::JoinReply reply;
               reply.client_uid = request.client_uid;
               reply.request_id = request.request_id;
               reply.accepted = refusal_.empty();
               reply.message = refusal_;
               reply.body_id = {first ? 40U : 41U};
               EXPECT_TRUE(replies_->Write(reply).ok());
             },
         .on_disposed = {}});
  }
  std::string Error(const GatewaySession& session) const {
    ServiceHealth health;
    session.FillHealth(health);
    return health.last_error;
  }
  static bool Never() { return false; }

  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(bus::inproc::MakeHub());
  std::unique_ptr<bus::Writer<roster::JoinReply>> replies_;
  std::unique_ptr<bus::Reader<roster::JoinRequest>> requests_;
  std::vector<roster::JoinRequest> heard_;
  std::string refusal_;
  GatewayConfig config_;
  DriverDescription description_;
};

TEST_F(GatewaySessionTest, EverybodyOfTheDriverJoinsAndGetsABody) {
  StartHost();
  const auto session = GatewaySession::Make(*bus_, config_, description_);
  ASSERT_TRUE(session.ok());
  EXPECT_TRUE((*session)->Wait(Never));
  EXPECT_THAT((*session)->bodies(), ElementsAre(BodyId{40}, BodyId{41}));
  EXPECT_EQ(heard_[1].sensors, description_.bodies[1].sensors);
  EXPECT_EQ(heard_[1].role, roster::Role::kPerformer);
  EXPECT_FALSE(heard_[1].wants_coil_slot);
  EXPECT_EQ(Error(**session), "");
}

TEST_F(GatewaySessionTest, WhoWearsCoilsAsksForASlot) {
  StartHost();
  description_.bodies[1].coil_slot = 1;
  const auto session = GatewaySession::Make(*bus_, config_, description_);
  EXPECT_TRUE((*session)->Wait(Never));
  EXPECT_FALSE(heard_[0].wants_coil_slot);
  EXPECT_TRUE(heard_[1].wants_coil_slot);
}

TEST_F(GatewaySessionTest, ThePersonOfTheConfigurationTakesTheDriversPlace) {
  StartHost();
  config_.person = "Ada";
  const auto session = GatewaySession::Make(*bus_, config_, description_);
  EXPECT_EQ(heard_[0].person, "Ada");
  EXPECT_EQ(heard_[1].person, "Ada 2");
}

TEST_F(GatewaySessionTest, WhatStandsInTheWayIsSaidAndWaitingCanBeEnded) {
  const auto session = GatewaySession::Make(*bus_, config_, description_);
  EXPECT_THAT(Error(**session), HasSubstr("no session host answers for session \"stage\""));
  int looks = 0;
  EXPECT_FALSE((*session)->Wait([&] { return ++looks > 2; }));
  refusal_ = "the session is full";
  StartHost();
  const auto refused = GatewaySession::Make(*bus_, config_, description_);
  EXPECT_THAT(Error(**refused), HasSubstr("refuses \"first\": the session is full"));
}

TEST_F(GatewaySessionTest, WithoutASessionHostNothingIsWaitedFor) {
  config_.session_host = false;
  StartHost();
  const auto session = GatewaySession::Make(*bus_, config_, description_);
  EXPECT_TRUE((*session)->Wait(Never));
  EXPECT_TRUE((*session)->bodies().empty());
  EXPECT_TRUE(heard_.empty());
  EXPECT_EQ(Error(**session), "");
}

TEST_F(GatewaySessionTest, ADriverThatKnowsNobodyIsRefused) {
  description_.bodies.clear();
  const auto session = GatewaySession::Make(*bus_, config_, description_);
  ASSERT_FALSE(session.ok());
  EXPECT_THAT(session.error().message, HasSubstr("two people says of no sensor"));
}

}  // namespace
}  // namespace limbcast::gateway
