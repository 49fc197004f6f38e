#include "common/client/client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "common/body/default_body.hpp"
#include "common/bus/inproc/inproc_bus.hpp"
#include "tests/support/fake_clock.hpp"

namespace limbcast::client {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace std::chrono_literals;

constexpr BodyId kBody{4};

/// What posture does as far as a client sees it.
class ClientTest : public ::testing::Test {
 protected:
  ClientTest() {
    definition_ = *body::MakeDefaultBody(kBody);
    definition_.name = "walker";
    definition_.revision = 1;
    definitions_ = *bus_->MakeWriter<body::BodyDefinition>();
    skeletons_ = *bus_->MakeWriter<body::Skeleton>();
    roster_ = *bus_->MakeWriter<roster::RosterEntry>();
    entry_.body_id = kBody;
    replies_ = *bus_->MakeWriter<roster::CommandReply>();
    commands_ = *bus_->MakeReader<roster::Command>(
        {.on_sample =
             [this](const roster::Command& command, const bus::SampleInfo&) {
               last_command_ = command;
               if (answer_) {
                 roster::CommandReply other;  // to another client, with the same number
                 other.client_uid = command.client_uid + 1;
                 other.request_id = command.request_id;
                 EXPECT_TRUE(replies_->Write(other).ok());
                 EXPECT_TRUE(replies_
                                 ->Write({.client_uid = command.client_uid,
                                          .request_id = command.request_id,
                                          .accepted = true,
                                          .message = "done"})
                                 .ok());
               }
             },
         .on_disposed = {}});
    auto client = Client::Attach(*bus_, clock_);
    EXPECT_TRUE(client.ok());
    client_ = std::move(*client);
  }

  void Enter(const std::string& person) {
    entry_.person = person;
    EXPECT_TRUE(roster_->Write(entry_).ok());
  }
  void Define() { EXPECT_TRUE(definitions_->Write(definition_).ok()); }
  void Show(Time at, float x_m) {
    body::Skeleton skeleton;
    skeleton.body_id = kBody;
    skeleton.definition_revision = definition_.revision;
    skeleton.measured_at = at;
    for (const body::SegmentDefinition& segment : definition_.segments) {
      body::SegmentPose pose;
      pose.segment = segment.segment;
      pose.p_earth_segment_m.x() = x_m;
      skeleton.segments.push_back(pose);
    }
    EXPECT_TRUE(skeletons_->Write(skeleton).ok());
  }

  test_support::FakeClock clock_;
  std::shared_ptr<bus::inproc::Hub> hub_ = bus::inproc::MakeHub(&clock_);
  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(hub_);
  body::BodyDefinition definition_;
  bool answer_ = true;
  roster::Command last_command_;
  std::unique_ptr<bus::Writer<body::BodyDefinition>> definitions_;
  std::unique_ptr<bus::Writer<body::Skeleton>> skeletons_;
  std::unique_ptr<bus::Writer<roster::RosterEntry>> roster_;
  roster::RosterEntry entry_;
  std::unique_ptr<bus::Writer<roster::CommandReply>> replies_;
  std::unique_ptr<bus::Reader<roster::Command>> commands_;
  std::unique_ptr<Client> client_;
};

TEST_F(ClientTest, PeopleAppearWithTheirDefinitionAndVanishWhenTheyLeave) {
  EXPECT_THAT(client_->Bodies(), IsEmpty());
  EXPECT_FALSE(client_->Definition(kBody).has_value());
  Define();
  EXPECT_THAT(client_->Bodies(), ElementsAre(kBody));
  EXPECT_EQ(client_->Definition(kBody)->name, "walker");
  Show(clock_.Now(), 1.0F);
  ASSERT_TRUE(definitions_->Dispose(definition_).ok());
  EXPECT_THAT(client_->Bodies(), IsEmpty());
  EXPECT_FALSE(client_->Latest(kBody).has_value());
}

TEST_F(ClientTest, WhoIsOutOfTheRosterIsGoneThoughNobodyDisposesOfTheDefinition) {
  // As when the posture service fell before the person left.
  std::vector<bool> presence;
  client_->OnBody([&](const body::BodyDefinition& body, bool present) {
    EXPECT_EQ(body.name, "walker");
    presence.push_back(present);
  });
  Enter("walker");
  Define();
  Show(clock_.Now(), 1.0F);
  ASSERT_TRUE(roster_->Dispose(entry_).ok());
  EXPECT_THAT(client_->Bodies(), IsEmpty());
  EXPECT_FALSE(client_->Definition(kBody).has_value());
  EXPECT_FALSE(client_->Latest(kBody).has_value());
  EXPECT_FALSE(client_->PoseAt(kBody, clock_.Now()).has_value());
  ASSERT_TRUE(definitions_->Dispose(definition_).ok());
  EXPECT_THAT(presence, ElementsAre(true, false)) << "told once";
}

TEST_F(ClientTest, WhoComesBackIsThereWhateverNewsComesFirst) {
  std::vector<bool> presence;
  client_->OnBody(
      [&](const body::BodyDefinition& /*body*/, bool present) { presence.push_back(present); });
  Enter("walker");
  Define();
  ASSERT_TRUE(roster_->Dispose(entry_).ok());
  Define();  // the new one is faster than the roster
  EXPECT_THAT(client_->Bodies(), IsEmpty());
  Enter("walker");
  EXPECT_THAT(client_->Bodies(), ElementsAre(kBody));
  EXPECT_THAT(presence, ElementsAre(true, false, true));
}

TEST_F(ClientTest, ABodyThatAnotherPersonGetsIsNotShownAsThatOfTheOneBefore) {
  Enter("walker");
  Define();
  ASSERT_TRUE(roster_->Dispose(entry_).ok());
  Enter("runner");
  EXPECT_THAT(client_->Bodies(), IsEmpty());
  definition_.name = "runner";
  Define();
  EXPECT_THAT(client_->Bodies(), ElementsAre(kBody));
}

TEST_F(ClientTest, ALateClientSeesWhoIsThere) {
  Define();
  auto late = Client::Attach(*bus_, clock_);
  ASSERT_TRUE(late.ok());
  EXPECT_THAT((*late)->Bodies(), ElementsAre(kBody));
}

TEST_F(ClientTest, LatestIsTheNewestSkeleton) {
  EXPECT_FALSE(client_->Latest(kBody).has_value());
  Show(clock_.Now(), 1.0F);
  Show(clock_.Now() + 10ms, 2.0F);
  EXPECT_FLOAT_EQ(client_->Latest(kBody)->segments[0].p_earth_segment_m.x(), 2.0F);
}

TEST_F(ClientTest, ThePoseAtADisplayTimeIsInterpolatedOrPredictedWithItsAge) {
  Define();
  EXPECT_FALSE(client_->PoseAt(kBody, clock_.Now()).has_value());
  for (int i = 0; i < 5; ++i) {
    Show(clock_.Now() + i * 10ms, static_cast<float>(i));
  }
  const auto between = client_->PoseAt(kBody, clock_.Now() + 25ms);
  ASSERT_TRUE(between.has_value());
  EXPECT_EQ(between->source, PoseSource::kInterpolated);
  EXPECT_NEAR(between->segments[0].p_earth_segment_m.x(), 2.5F, 1e-4F);
  const auto ahead = client_->PoseAt(kBody, clock_.Now() + 60ms);
  EXPECT_EQ(ahead->source, PoseSource::kPredicted);
  EXPECT_EQ(ahead->age, 20ms);
  EXPECT_NEAR(ahead->segments[0].p_earth_segment_m.x(), 6.0F, 1e-4F);
}

TEST_F(ClientTest, CallbacksTellOfSkeletonsAndPeopleUntilTheyAreTakenBack) {
  int skeletons = 0;
  std::vector<bool> presence;
  client_->OnSkeleton([&](const body::Skeleton& skeleton) {
    EXPECT_EQ(skeleton.body_id, kBody);
    EXPECT_TRUE(client_->Latest(kBody).has_value()) << "the client may be asked from a callback";
    ++skeletons;
  });
  client_->OnBody([&](const body::BodyDefinition& body, bool present) {
    EXPECT_EQ(body.name, "walker");
    presence.push_back(present);
  });
  Define();
  Show(clock_.Now(), 0.0F);
  ASSERT_TRUE(definitions_->Dispose(definition_).ok());
  EXPECT_EQ(skeletons, 1);
  EXPECT_THAT(presence, ElementsAre(true, false));
  client_->OnSkeleton({});
  Show(clock_.Now() + 10ms, 0.0F);
  EXPECT_EQ(skeletons, 1);
}

TEST_F(ClientTest, ACommandReachesTheServiceAndItsAnswerComesBack) {
  Define();
  const auto reply = client_->Send(roster::CommandKind::kSetDimensions, kBody, "height", {1.8});
  ASSERT_TRUE(reply.ok()) << reply.error().message;
  EXPECT_TRUE(reply->accepted) << "not the answer to the other client";
  EXPECT_EQ(reply->message, "done");
  EXPECT_EQ(last_command_.kind, roster::CommandKind::kSetDimensions);
  EXPECT_EQ(last_command_.text, "height");
  EXPECT_THAT(last_command_.numbers, ElementsAre(1.8));
}

TEST_F(ClientTest, WithoutAnAnswerSendSaysSoAndALateAnswerIsNotTakenForTheNext) {
  Define();
  answer_ = false;
  const auto none = client_->Send(roster::CommandKind::kUndo, kBody, "", {}, 10ms);
  ASSERT_FALSE(none.ok());
  EXPECT_EQ(none.error().code, ErrorCode::kTimeout);
  const roster::CommandReply late{.client_uid = last_command_.client_uid,
                                  .request_id = last_command_.request_id,
                                  .accepted = true,
                                  .message = "late"};
  ASSERT_TRUE(replies_->Write(late).ok());
  answer_ = true;
  EXPECT_EQ(client_->Send(roster::CommandKind::kUndo, kBody)->message, "done");
}

TEST_F(ClientTest, ACommandForNobodyOrWithoutAServiceFailsByName) {
  const auto nobody = client_->Send(roster::CommandKind::kUndo, BodyId{77}, "", {}, 10ms);
  ASSERT_FALSE(nobody.ok());
  EXPECT_EQ(nobody.error().code, ErrorCode::kNotFound);
  EXPECT_THAT(nobody.error().message, HasSubstr("no body 77"));
  Define();
  commands_.reset();
  const auto deaf = client_->Send(roster::CommandKind::kUndo, kBody, "", {}, 10ms);
  ASSERT_FALSE(deaf.ok());
  EXPECT_EQ(deaf.error().code, ErrorCode::kUnavailable);
}

TEST(ClientOptionsTest, BadOptionsAreRefusedByName) {
  const auto message = [](const ClientOptions& options) {
    const auto client = Client::Connect(options);
    return client.ok() ? std::string() : client.error().message;
  };
  EXPECT_THAT(message({.dds = "carrier-pigeon"}), HasSubstr("carrier-pigeon"));
  EXPECT_THAT(message({.dds = "inproc", .domain_id = 500}), HasSubstr("500"));
  EXPECT_THAT(message({.dds = "inproc", .history = 1}), HasSubstr("[2, 4096]"));
  EXPECT_THAT(message({.dds = "inproc", .max_prediction = 2s}), HasSubstr("[0, 1] s"));
}

TEST(ClientOptionsTest, ConnectJoinsTheNetworkThatIsAskedFor) {
  const auto client = Client::Connect({.dds = "inproc", .domain_id = 9, .partition = "stage"});
  ASSERT_TRUE(client.ok()) << client.error().message;
  EXPECT_THAT((*client)->Describe(), HasSubstr("stage"));
  const Time first = (*client)->Now();
  EXPECT_GT(first, TimeFromNanoseconds(1'600'000'000'000'000'000)) << "the Unix epoch";
}

}  // namespace
}  // namespace limbcast::client
