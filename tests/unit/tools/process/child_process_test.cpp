#include "tools/process/child_process.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <string>

namespace limbcast::process {
namespace {

using namespace std::chrono_literals;

Result<ChildProcess> Shell(const std::string& script) {
  return ChildProcess::Start({.arguments = {"/bin/sh", "-c", script}});
}

TEST(ChildProcessTest, CapturesWhatItWritesAndItsExitStatus) {
  auto child = Shell("echo out; echo err >&2; exit 3");
  ASSERT_TRUE(child.ok());

  const auto ended = child->Wait(20s);

  ASSERT_TRUE(ended.has_value());
  EXPECT_EQ(ended->status, 3);
  EXPECT_EQ(ended->signal, 0);
  EXPECT_FALSE(ended->clean());
  EXPECT_EQ(child->Output(), "out\n");
  EXPECT_EQ(child->Errors(), "err\n");
}

TEST(ChildProcessTest, StartOfWhatIsNotThereNamesItAndTheReason) {
  const auto child = ChildProcess::Start({.arguments = {"/nowhere/limbcast"}});

  ASSERT_FALSE(child.ok());
  EXPECT_EQ(child.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(child.error().message, "cannot start /nowhere/limbcast: No such file or directory");
}

TEST(ChildProcessTest, FilesOfTheParentAreNoneOfTheChilds) {
  const int fd = open("/dev/null", O_RDONLY);  // NOLINT(*-vararg): POSIX
  ASSERT_GT(fd, STDERR_FILENO);
  auto child = Shell("test ! -e /proc/self/fd/" + std::to_string(fd));
  ASSERT_TRUE(child.ok());
  const auto ended = child->Wait(20s);
  close(fd);
  ASSERT_TRUE(ended.has_value());
  EXPECT_EQ(ended->status, 0);
}

TEST(ChildProcessTest, PollOfARunningChildIsNothing) {
  auto child = Shell("exec sleep 100");
  ASSERT_TRUE(child.ok());
  EXPECT_FALSE(child->Poll().has_value());
}

TEST(ChildProcessTest, SignalEndsItAndIsReported) {
  auto child = Shell("exec sleep 100");
  ASSERT_TRUE(child.ok());
  child->Signal(SIGKILL);
  const auto ended = child->Wait(20s);
  ASSERT_TRUE(ended.has_value());
  EXPECT_EQ(ended->signal, SIGKILL);
}

TEST(ChildProcessTest, StopKillsWhoDoesNotListen) {
  auto child = Shell("trap '' TERM; echo ready; while :; do sleep 1; done");
  ASSERT_TRUE(child.ok());
  while (child->Output().empty() && !child->Poll()) {
  }
  EXPECT_EQ(child->Stop(100ms).signal, SIGKILL);
}

TEST(ChildProcessTest, EnvironmentIsPutOverOurOwn) {
  auto child = ChildProcess::Start({.arguments = {"/bin/sh", "-c", "echo $HOME $LIMBCAST_X"},
                                    .environment = {"HOME=/h", "LIMBCAST_X=1"}});
  ASSERT_TRUE(child.ok());
  ASSERT_TRUE(child->Wait(20s).has_value());
  EXPECT_EQ(child->Output(), "/h 1\n");
}

TEST(ChildProcessTest, DescendantsAreFoundBySession) {
  auto child = Shell("sleep 100 & echo ready; wait");
  ASSERT_TRUE(child.ok());
  while (child->Output().empty() && !child->Poll()) {
  }
  EXPECT_EQ(SessionMembers(child->pid()).size(), 2U);

  const pid_t session = child->pid();
  kill(-session, SIGKILL);
  ASSERT_TRUE(child->Wait(20s).has_value());
  // The orphan is reaped by init; it no longer counts as alive as soon as it is a zombie.
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  while (!SessionMembers(session).empty() && std::chrono::steady_clock::now() < deadline) {
  }
  EXPECT_TRUE(SessionMembers(session).empty());
}

}  // namespace
}  // namespace limbcast::process
