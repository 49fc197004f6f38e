#include "common/config/command_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace limbcast::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::internal::CaptureStderr;
using ::testing::internal::CaptureStdout;
using ::testing::internal::GetCapturedStderr;
using ::testing::internal::GetCapturedStdout;

CommandLine MakeCommand() {
  return CommandLine("limbcast-x", "Does x.", "  limbcast-x --config x.toml");
}

template <typename... Args>
std::optional<int> ParseArgs(CommandLine& command, Args... args) {
  const std::array<const char*, sizeof...(Args) + 1> argv{"limbcast-x", args...};
  return command.Parse(static_cast<int>(argv.size()), argv.data());
}

TEST(CommandLineTest, WithoutOptionsTheProgramGoesOnWithDefaults) {
  CommandLine command = MakeCommand();
  EXPECT_EQ(ParseArgs(command), std::nullopt);
  EXPECT_TRUE(command.LoadConfig().ok());
}

TEST(CommandLineTest, HelpShowsOptionsAndExamplesAndEndsWithSuccess) {
  CommandLine command = MakeCommand();
  CaptureStdout();
  EXPECT_EQ(ParseArgs(command, "--help"), 0);
  EXPECT_THAT(GetCapturedStdout(), AllOf(HasSubstr("Does x."), HasSubstr("--config"),
                                         HasSubstr("Examples:\n  limbcast-x --config x.toml")));
}

TEST(CommandLineTest, VersionIsThatOfTheProject) {
  CommandLine command = MakeCommand();
  CaptureStdout();
  EXPECT_EQ(ParseArgs(command, "--version"), 0);
  EXPECT_EQ(GetCapturedStdout(), "limbcast-x " + std::string(Version()) + "\n");
  EXPECT_FALSE(Version().empty());
}

TEST(CommandLineTest, ABadOptionGivesOneLineThatNamesItAndStatusTwo) {
  CommandLine command = MakeCommand();
  int rate = 0;
  command.app().add_option("--rate", rate)->check(CLI::Range(1, 1000));
  for (const auto& [option, value] :
       {std::pair{"--frobnicate", "1"}, {"--rate", "0"}, {"--rate", "x"}}) {
    CaptureStderr();
    EXPECT_EQ(ParseArgs(command, option, value), 2);
    const std::string message = GetCapturedStderr();
    EXPECT_THAT(message, AllOf(HasSubstr("limbcast-x: "), HasSubstr(option)));
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 1) << message;
  }
}

TEST(CommandLineTest, ConfigAndSetMakeTheConfiguration) {
  const std::filesystem::path path =
      std::filesystem::path(::testing::TempDir()) / "limbcast_command_line_test.toml";
  std::ofstream(path) << "a = 1\nb = 2\n";
  CommandLine command = MakeCommand();
  const std::string path_text = path.string();
  ASSERT_EQ(ParseArgs(command, "--config", path_text.c_str(), "--set", "a=5", "--set", "c=word"),
            std::nullopt);
  const Result<ConfigFile> file = command.LoadConfig();
  std::filesystem::remove(path);
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->Root().Read("a", 0, 0, 9), 5);
  EXPECT_EQ(file->Root().Read("b", 0, 0, 9), 2);
  EXPECT_EQ(file->Root().Read("c", "", 9), "word");
}

TEST(CommandLineTest, ASecondFileGoesOverTheFirstAndIsNamedInMessages) {
  const test_support::TemporaryFolder folder;
  const std::string first = folder / "first.toml";
  const std::string second = folder / "second.toml";
  std::ofstream(first) << "[t]\na = 1\nb = 2\n";
  std::ofstream(second) << "[t]\n\nb = 33\nc = 4\n";
  CommandLine command = MakeCommand();
  ASSERT_EQ(
      ParseArgs(command, "--config", first.c_str(), "--config", second.c_str(), "--set", "t.c=5"),
      std::nullopt);
  const Result<ConfigFile> file = command.LoadConfig();
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->Get("t").Read("a", 0, 0, 9), 1);
  EXPECT_EQ(file->Get("t").Read("c", 0, 0, 9), 5);
  EXPECT_TRUE(file->Get("t").Has("b"));
  EXPECT_EQ(file->Get("t").Read("b", 0, 0, 9), 0);
  EXPECT_EQ(file->Finish().error().message, second + ":3: t.b must be in [0, 9], is 33");
}

TEST(CommandLineTest, AnUnreadableFileAndABadSetAreRefused) {
  CommandLine missing = MakeCommand();
  ASSERT_EQ(ParseArgs(missing, "--config", "/nonexistent.toml"), std::nullopt);
  ASSERT_FALSE(missing.LoadConfig().ok());
  EXPECT_THAT(missing.LoadConfig().error().message, HasSubstr("/nonexistent.toml"));
  CommandLine bad = MakeCommand();
  ASSERT_EQ(ParseArgs(bad, "--set", "nonsense"), std::nullopt);
  EXPECT_FALSE(bad.LoadConfig().ok());
}

TEST(CommandLineTest, FailSaysOneLineAndTellsMistakesFromRefusals) {
  const CommandLine command = MakeCommand();
  CaptureStderr();
  EXPECT_EQ(command.Fail({ErrorCode::kInvalidArgument, "x.rate must be in [1, 9], is 0\n"}), 2);
  EXPECT_EQ(GetCapturedStderr(), "limbcast-x: x.rate must be in [1, 9], is 0\n");
  EXPECT_EQ(command.Fail({ErrorCode::kNotFound, "no file"}), 2);
  EXPECT_EQ(command.Fail({ErrorCode::kCorruptData, "cut off"}), 2);
  EXPECT_EQ(command.Fail({ErrorCode::kUnavailable, "domain 3 has no free participant index"}), 1);
}

}  // namespace
}  // namespace limbcast::config
