#include "common/client/session_member.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <thread>
#include <utility>

#include "common/bus/inproc/inproc_bus.hpp"

namespace limbcast::client {
namespace {

using namespace std::chrono_literals;
using roster::Role;
using ::testing::HasSubstr;

// What a session host does as far as a member sees it.
class SessionMemberTest : public ::testing::Test {
 protected:
  void StartHost() {
    replies_ = *bus_->MakeWriter<roster::JoinReply>();
    command_replies_ = *bus_->MakeWriter<roster::CommandReply>();
    requests_ = *bus_->MakeReader<roster::JoinRequest>(
        {.on_sample = [this](const roster::JoinRequest& r, const bus::SampleInfo&) { Hear(r); },
         .on_disposed = {}});
    commands_ = *bus_->MakeReader<roster::Command>(
        {.on_sample =
             [this](const roster::Command& c, const bus::SampleInfo&) {
               heard_commands_.push_back(c);
               EXPECT_TRUE(command_replies_
                               ->Write({.client_uid = c.client_uid,
                                        .request_id = c.request_id,
                                        .accepted = true,
                                        .message = "done"})
                               .ok());
             },
         .on_disposed = {}});
  }
  void StopHost() {
    requests_.reset();
    commands_.reset();
    replies_.reset();
    command_replies_.reset();
  }
  void Hear(const roster::JoinRequest& request) {
    heard_.push_back(request);
    if (!answer_) {
      return;
    }
    roster::JoinReply reply{.client_uid = request.client_uid + 1,  // somebody else's first
                            .request_id = request.request_id,
                            .accepted = true,
                            .body_id = {99},
                            .partition = "stage",
                            .message = ""};
    EXPECT_TRUE(replies_->Write(reply).ok());
    reply.client_uid = request.client_uid;
    reply.body_id = {request.person == "Ada" ? 1U : 2U};
    reply.accepted = refusal_.empty();
    reply.message = refusal_;
    EXPECT_TRUE(replies_->Write(reply).ok());
  }
  std::unique_ptr<SessionMember> Make(std::vector<Membership> as) {
    auto made = SessionMember::Make(*bus_, "stage", std::move(as),
                                    [this](std::size_t index, const MemberStatus& status) {
                                      changes_.emplace_back(index, status);
                                    });
    EXPECT_TRUE(made.ok());
    return std::move(*made);
  }
  static Membership Ada() {
    return {.role = Role::kPerformer,
            .person = "Ada",
            .sensors = {{.sensor_uid = {11}, .segment = body::Segment::kHead}}};
  }
  static Membership Bob() { return {.role = Role::kSpectator, .person = "Bob", .sensors = {}}; }

  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(bus::inproc::MakeHub());
  std::unique_ptr<bus::Writer<roster::JoinReply>> replies_;
  std::unique_ptr<bus::Writer<roster::CommandReply>> command_replies_;
  std::unique_ptr<bus::Reader<roster::JoinRequest>> requests_;
  std::unique_ptr<bus::Reader<roster::Command>> commands_;
  std::vector<roster::JoinRequest> heard_;
  std::vector<roster::Command> heard_commands_;
  std::vector<std::pair<std::size_t, MemberStatus>> changes_;
  bool answer_ = true;
  std::string refusal_;
};

TEST_F(SessionMemberTest, AsksForEachMembershipAndIsToldItsBody) {
  StartHost();
  const auto member = Make({Ada(), Bob()});
  EXPECT_EQ(member->status(0).state, MemberState::kAsking);
  member->Tick();
  EXPECT_TRUE(member->WaitUntilJoined(0s).ok());
  EXPECT_EQ(member->status(0).body_id.value, 1U);
  ASSERT_EQ(heard_.size(), 2U);
  EXPECT_EQ(heard_[0].session, "stage");
  EXPECT_EQ(heard_[0].person, "Ada");
  EXPECT_EQ(heard_[0].role, Role::kPerformer);
  EXPECT_EQ(heard_[0].sensors, Ada().sensors);
  EXPECT_EQ(heard_[1].role, Role::kSpectator);
  EXPECT_EQ(heard_[0].client_uid, heard_[1].client_uid);
  EXPECT_EQ(changes_.size(), 2U);
}

TEST_F(SessionMemberTest, ARequestIsRepeatedAsItWasOnceAnsweredAndAnewUntilThen) {
  StartHost();
  answer_ = false;
  const auto member = Make({Ada()});
  member->Tick();
  member->Tick();
  answer_ = true;
  member->Tick();
  member->Tick();
  member->Tick();
  ASSERT_EQ(heard_.size(), 5U);
  EXPECT_NE(heard_[0].request_id, heard_[1].request_id);
  EXPECT_NE(heard_[1].request_id, heard_[2].request_id);
  EXPECT_EQ(heard_[2].request_id, heard_[3].request_id);
  EXPECT_EQ(heard_[3].request_id, heard_[4].request_id);
  EXPECT_EQ(changes_.size(), 1U) << "the same answer is no news";
}

TEST_F(SessionMemberTest, WithoutAHostThereIsNoAnswerAndOneThatComesIsFound) {
  const auto member = Make({Ada()});
  member->Tick();
  const Status waited = member->WaitUntilJoined(1ms);
  ASSERT_FALSE(waited.ok());
  EXPECT_EQ(waited.error().code, ErrorCode::kTimeout);
  EXPECT_THAT(waited.error().message, HasSubstr("session \"stage\""));
  StartHost();
  member->Tick();
  EXPECT_TRUE(member->WaitUntilJoined(0s).ok());
}

TEST_F(SessionMemberTest, ARefusalIsSaidAndAskedAgainLater) {
  StartHost();
  refusal_ = "no room";
  const auto member = Make({Ada()});
  member->Tick();
  const Status waited = member->WaitUntilJoined(0s);
  ASSERT_FALSE(waited.ok());
  EXPECT_EQ(waited.error().code, ErrorCode::kUnavailable);
  EXPECT_THAT(waited.error().message, HasSubstr("\"Ada\" refused: no room"));
  refusal_.clear();
  for (int i = 0; i < 2; ++i) {
    member->Tick();
    EXPECT_EQ(heard_.size(), 1U) << "not as often as one that may come";
  }
  member->Tick();
  EXPECT_EQ(member->status(0).state, MemberState::kMember);
  // Sent away later, and taken back.
  refusal_ = "the session is full";
  member->Tick();
  EXPECT_EQ(member->status(0).state, MemberState::kRefused);
  EXPECT_EQ(member->status(0).body_id.value, 1U) << "what it was";
  refusal_.clear();
  for (int i = 0; i < 3; ++i) {
    member->Tick();
  }
  EXPECT_EQ(member->status(0).state, MemberState::kMember);
  EXPECT_EQ(changes_.size(), 4U);
}

TEST_F(SessionMemberTest, LeavesInGoodOrderOnce) {
  StartHost();
  {
    const auto member = Make({Ada()});
    member->Tick();
    member->Leave();
  }
  ASSERT_EQ(heard_commands_.size(), 1U);
  EXPECT_EQ(heard_commands_[0].kind, roster::CommandKind::kLeaveSession);
  EXPECT_EQ(heard_commands_[0].client_uid, heard_[0].client_uid);
  { const auto never_joined = Make({Ada()}); }
  EXPECT_EQ(heard_commands_.size(), 1U);
  {
    const auto member = Make({Ada()});
    member->Tick();
    StopHost();
  }
  EXPECT_EQ(heard_commands_.size(), 1U) << "nobody to say it to";
}

TEST_F(SessionMemberTest, AsksByItselfOnceStarted) {
  StartHost();
  const auto member = Make({Ada()});
  member->Start();
  EXPECT_TRUE(member->WaitUntilJoined(10s).ok());
  EXPECT_EQ(member->Ask(roster::CommandKind::kReleasePerson, "Bob", 10s)->message, "done");
  EXPECT_EQ(heard_commands_[0].text, "Bob");
}

TEST_F(SessionMemberTest, WhoHasWaitedFindsThatTheChangeHasBeenTold) {
  StartHost();
  std::promise<void> entered;
  std::promise<void> released;
  auto made = SessionMember::Make(*bus_, "stage", {Ada()}, [&](std::size_t, const MemberStatus&) {
    entered.set_value();
    released.get_future().wait();
  });
  ASSERT_TRUE(made.ok());
  std::thread network([&] { (*made)->Tick(); });  // the answer comes on the asking thread here
  entered.get_future().wait();
  EXPECT_EQ((*made)->status(0).state, MemberState::kMember);
  EXPECT_FALSE((*made)->WaitUntilJoined(0s).ok());
  released.set_value();
  EXPECT_TRUE((*made)->WaitUntilJoined(10s).ok());
  network.join();
}

}  // namespace
}  // namespace limbcast::client
