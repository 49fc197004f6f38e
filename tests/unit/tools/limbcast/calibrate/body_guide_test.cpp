#include "tools/limbcast/calibrate/body_guide.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

namespace limbcast::tool {
namespace {

using roster::CommandKind;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A posture service that answers as told, and a person who has all the time in the world.
class BodyGuideTest : public ::testing::Test {
 protected:
  Result<std::string> Guide(const BodyGuideOptions& options) {
    return GuideBody(
        {.ask = [this](CommandKind kind, const std::string& text,
                       const std::vector<double>& numbers) -> Result<roster::CommandReply> {
           asked_.push_back(std::to_string(static_cast<int>(kind)) + " " + text);
           numbers_ = numbers;
           roster::CommandReply reply{.accepted = true, .message = "done"};
           if (!refusals_.empty()) {
             reply.message = refusals_.front();
             reply.accepted = reply.message.empty();
             refusals_.pop_front();
           }
           return reply;
         },
         .say = [this](const std::string& line) { said_.push_back(line); },
         .wait =
             [this](double seconds) {
               waited_s_ += seconds;
               return waited_s_ <= patience_s_;
             }},
        options);
  }

  std::deque<std::string> refusals_;  // "" = accepted
  double patience_s_ = 1e6;
  double waited_s_ = 0.0;
  std::vector<std::string> asked_;
  std::vector<double> numbers_;
  std::vector<std::string> said_;
};

TEST_F(BodyGuideTest, PoseWalkAndProfileInThatOrder) {
  const auto done = Guide({.countdown_s = 3.0, .walk_s = 20.0, .profile = "Anna"});
  ASSERT_TRUE(done.ok()) << done.error().message;
  EXPECT_THAT(asked_, ElementsAre("0 n_pose", "5 start", "5 finish", "7 save Anna"));
  EXPECT_EQ(waited_s_, 23.0);
  EXPECT_THAT(said_, Contains(HasSubstr("Stand upright")));
  EXPECT_THAT(said_, Contains("reference pose in 1 s"));
  EXPECT_THAT(said_, Contains(HasSubstr("Walk, as you always do")));
}

TEST_F(BodyGuideTest, WhoMovesIsToldSoAndAskedAgain) {
  refusals_ = {"moving more than 3.4 deg within 0.3 s: head", ""};
  ASSERT_TRUE(Guide({.walk_s = 0.0}).ok());
  EXPECT_THAT(asked_, ElementsAre("0 n_pose", "0 n_pose"));
  EXPECT_THAT(said_, Contains("not yet: moving more than 3.4 deg within 0.3 s: head"));
}

TEST_F(BodyGuideTest, AWalkThatCannotBeUsedPutsTheOldAlignmentBackAndSaysWhy) {
  refusals_ = {"", "", "no steady walking in these 20 s"};
  const auto done = Guide({.walk_s = 20.0, .profile = "Anna"});
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(done.error().message, "no steady walking in these 20 s");
  EXPECT_THAT(asked_, ElementsAre("0 n_pose", "5 start", "5 finish", "4 "));
}

TEST_F(BodyGuideTest, GivingUpWhileWalkingChangesNothing) {
  patience_s_ = 10.0;
  EXPECT_FALSE(Guide({.countdown_s = 3.0, .walk_s = 20.0}).ok());
  EXPECT_THAT(asked_, ElementsAre("0 n_pose", "5 start", "5 cancel", "4 "));
}

TEST_F(BodyGuideTest, AProfileThatCannotBeSavedIsToldApartFromAnAlignmentThatFailed) {
  refusals_ = {"", "posture.state_dir is empty: nothing is kept"};
  EXPECT_EQ(Guide({.walk_s = 0.0, .profile = "Anna"}).error().message,
            "the alignment is in force, but profile Anna was not saved: posture.state_dir is "
            "empty: nothing is kept");
}

TEST_F(BodyGuideTest, FacingGoesWithThePose) {
  ASSERT_TRUE(Guide({.pose = "t_pose", .facing_rad = 1.5, .walk_s = 0.0}).ok());
  EXPECT_EQ(numbers_, std::vector<double>{1.5});
  EXPECT_THAT(said_, Contains(HasSubstr("arms straight out")));
}

TEST_F(BodyGuideTest, ARefusalThatStaysIsGivenBack) {
  refusals_ = {"no", "no", "no", "no", "no"};
  EXPECT_EQ(Guide({}).error().message, "no");
  EXPECT_EQ(asked_.size(), 4U);
}

}  // namespace
}  // namespace limbcast::tool
