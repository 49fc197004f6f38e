// With small scripts in place of the services.
#include "tools/limbcast/demo/pipeline_processes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class PipelineProcessesTest : public ::testing::Test {
 protected:
  PipelineProcessesTest() { options_.folder = temporary_.path().string(); }

  void Script(const std::string& part, const std::string& text) const {
    const auto path = std::filesystem::path(options_.folder) / ("limbcast-" + part);
    std::ofstream(path) << "#!/bin/sh\n" << text << '\n';
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }

  // Looks after them until `done`, or fails after a generous while.
  template <typename Done>
  static Status SuperviseUntil(PipelineProcesses& processes, Done done) {
    const auto deadline = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < deadline) {
      if (const Status alive = processes.Supervise(); !alive) {
        return alive;
      }
      if (done()) {
        return Ok();
      }
    }
    return Error{ErrorCode::kTimeout, "nothing happened"};
  }

  const test_support::TemporaryFolder temporary_;
  DemoOptions options_;
};

TEST_F(PipelineProcessesTest, SettingsGoToTheServiceTheyAreFor) {
  options_.fusion_settings = {"filter.name=ckf"};
  options_.gateway_settings = {"simulator.persons=2"};
  EXPECT_EQ(ArgumentsOf(Part::kFusion, options_).back(), "filter.name=ckf");
  EXPECT_EQ(ArgumentsOf(Part::kGateway, options_).back(), "simulator.persons=2");
  EXPECT_THAT(ArgumentsOf(Part::kPosture, options_),
              ::testing::Not(::testing::Contains(HasSubstr("filter.name"))));
  EXPECT_THAT(ArgumentsOf(Part::kGateway, options_),
              ::testing::Not(::testing::Contains(HasSubstr("filter.name"))));
}

TEST_F(PipelineProcessesTest, CoilsAndMarkersAreWornAndListenedTo) {
  using ::testing::Contains;
  EXPECT_THAT(ArgumentsOf(Part::kGateway, options_), ::testing::Not(Contains(HasSubstr("coils"))));
  options_.coils = options_.markers = true;
  EXPECT_THAT(ArgumentsOf(Part::kGateway, options_), Contains("simulator.coils.source=pelvis"));
  EXPECT_THAT(ArgumentsOf(Part::kFusion, options_), Contains("fusion.coils.source=pelvis"));
  EXPECT_THAT(ArgumentsOf(Part::kGateway, options_), Contains(HasSubstr("cameras.markers")));
  EXPECT_THAT(ArgumentsOf(Part::kFusion, options_), Contains(HasSubstr("markers.segments")));
  options_.fusion_settings = {"fusion.coils.source=t8"};
  EXPECT_EQ(ArgumentsOf(Part::kFusion, options_).back(), "fusion.coils.source=t8");
}

TEST_F(PipelineProcessesTest, RecordingIsPlayedToItsEndAsFastAsItGoes) {
  options_.recording = "/data/a b.hdf5";
  const auto arguments = ArgumentsOf(Part::kGateway, options_);
  const std::vector<std::string> last(arguments.end() - 5, arguments.end());
  EXPECT_THAT(last, ::testing::ElementsAre("--recording", "/data/a b.hdf5", "--exit-at-end",
                                           "--speed", "max"));
  options_.speed = "2";
  EXPECT_EQ(ArgumentsOf(Part::kGateway, options_).back(), "2");
}

TEST_F(PipelineProcessesTest, WhatRefusesToRunIsToldInItsOwnWords) {
  Script("fusion", "echo first >&2; echo 'limbcast-fusion: domain 7 is in use' >&2; exit 1");
  PipelineProcesses processes(options_);
  ASSERT_TRUE(processes.Start(Part::kFusion).ok());
  const Status status = SuperviseUntil(processes, [] { return false; });
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "limbcast-fusion: domain 7 is in use");
  EXPECT_EQ(status.error().code, ErrorCode::kUnavailable);
  EXPECT_FALSE(processes.clean());
}

TEST_F(PipelineProcessesTest, WhatIsNotThereIsNamed) {
  PipelineProcesses processes(options_);
  const Status status = processes.Start(Part::kPosture);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("limbcast-posture: No such file"));
}

TEST_F(PipelineProcessesTest, WhoIsKilledIsStartedAgainAndThatIsNoFailure) {
  Script("posture", "exec sleep 100");
  PipelineProcesses processes(options_);
  ASSERT_TRUE(processes.Start(Part::kPosture).ok());
  const std::uint32_t first = processes.pid(Part::kPosture);
  kill(static_cast<pid_t>(first), SIGKILL);
  const Status status =
      SuperviseUntil(processes, [&] { return processes.pid(Part::kPosture) != first; });
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(processes.restarts().at("posture"), 1);
  EXPECT_TRUE(processes.clean());
}

TEST_F(PipelineProcessesTest, ACrashIsStartedAgainButIsNotClean) {
  Script("posture", "exec sleep 100");
  PipelineProcesses processes(options_);
  ASSERT_TRUE(processes.Start(Part::kPosture).ok());
  kill(static_cast<pid_t>(processes.pid(Part::kPosture)), SIGSEGV);
  EXPECT_TRUE(SuperviseUntil(processes, [&] { return !processes.restarts().empty(); }).ok());
  EXPECT_FALSE(processes.clean());
}

TEST_F(PipelineProcessesTest, GatewayThatEndsWithItsRecordingHasFinished) {
  options_.recording = "/data/x.hdf5";
  Script("gateway", "exit 0");
  PipelineProcesses processes(options_);
  ASSERT_TRUE(processes.Start(Part::kGateway).ok());
  EXPECT_TRUE(SuperviseUntil(processes, [&] { return processes.gateway_finished(); }).ok());
  EXPECT_TRUE(processes.clean());
  EXPECT_EQ(processes.leftovers(), 0U);
}

TEST_F(PipelineProcessesTest, StopIsCleanOnlyWithStatusZero) {
  Script("fusion", "trap 'exit 0' TERM; echo ready >&2; while :; do sleep 0.01; done");
  Script("posture", "trap 'exit 3' TERM; echo ready >&2; while :; do sleep 0.01; done");
  PipelineProcesses processes(options_);
  ASSERT_TRUE(processes.Start(Part::kFusion).ok());
  ASSERT_TRUE(processes.Start(Part::kPosture).ok());
  ASSERT_TRUE(SuperviseUntil(processes, [&] {
                return processes.Errors() == "fusion: ready\nposture: ready\n";
              }).ok());
  EXPECT_TRUE(processes.Stop(Part::kFusion));
  EXPECT_TRUE(processes.clean());
  EXPECT_FALSE(processes.Stop(Part::kPosture));
  EXPECT_FALSE(processes.clean());
}

}  // namespace
}  // namespace limbcast::tool
