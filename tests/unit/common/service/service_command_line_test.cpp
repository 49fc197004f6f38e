#include "common/service/service_command_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <array>
#include <string>
#include <vector>

namespace limbcast::service {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <typename... Args>
Result<bus::BusConfig> BusOf(const config::ConfigFile& file, Args... args) {
  ServiceCommandLine command("limbcast-x", "Does x.", "  limbcast-x");
  const std::array<const char*, sizeof...(Args) + 1> argv{"limbcast-x", args...};
  EXPECT_EQ(command.Parse(static_cast<int>(argv.size()), argv.data()), std::nullopt);
  return command.ReadBus(file);
}

config::ConfigFile File(std::string_view text) {
  return *config::ConfigFile::Parse(text, "t.toml");
}

TEST(ServiceCommandLineTest, DefaultsAreThoseOfTheBusNamedAfterTheProgram) {
  const auto bus = BusOf(config::ConfigFile());
  ASSERT_TRUE(bus.ok());
  EXPECT_EQ(bus->vendor, bus::Vendor::kCyclone);
  EXPECT_EQ(bus->domain_id, 42U);
  EXPECT_EQ(bus->network, bus::NetworkProfile::kLoopback);
  EXPECT_EQ(bus->participant_name, "limbcast-x");
  EXPECT_EQ(bus->security_dir, "");
}

TEST(ServiceCommandLineTest, ReadsEveryKeyOfTheBusTable) {
  const config::ConfigFile file = File(R"(
[bus]
dds = "fast"
domain_id = 7
partition = "stage"
network = "lan"
peers = ["10.0.0.2"]
ownership_strength = 20
stream_lease_s = 0.25
stream_depth = 32
send_loss_permille = 20
write_batching = true
security_dir = "credentials"
security_role = "operator"
)");
  const auto bus = BusOf(file);
  ASSERT_TRUE(bus.ok());
  EXPECT_TRUE(file.Finish().ok());
  EXPECT_EQ(bus->vendor, bus::Vendor::kFast);
  EXPECT_EQ(bus->domain_id, 7U);
  EXPECT_EQ(bus->partition, "stage");
  EXPECT_EQ(bus->network, bus::NetworkProfile::kLan);
  EXPECT_THAT(bus->peers, ElementsAre("10.0.0.2"));
  EXPECT_EQ(bus->ownership_strength, 20);
  EXPECT_EQ(bus->stream_lease, std::chrono::milliseconds(250));
  EXPECT_EQ(bus->stream_depth, 32);
  EXPECT_EQ(bus->send_loss_permille, 20);
  EXPECT_EQ(bus->security_dir, "credentials");
  EXPECT_EQ(bus->security_role, "operator");
  EXPECT_TRUE(bus->write_batching);
}

TEST(ServiceCommandLineTest, TheCommandLineGoesOverTheFile) {
  const auto bus = BusOf(File("[bus]\ndds = \"fast\"\ndomain_id = 7\npartition = \"a\"\n"), "--dds",
                         "inproc", "--domain", "9", "--partition", "b", "--network", "lan",
                         "--peer", "10.0.0.1", "--peer", "10.0.0.2");
  ASSERT_TRUE(bus.ok());
  EXPECT_EQ(bus->vendor, bus::Vendor::kInproc);
  EXPECT_EQ(bus->domain_id, 9U);
  EXPECT_EQ(bus->partition, "b");
  EXPECT_EQ(bus->network, bus::NetworkProfile::kLan);
  EXPECT_THAT(bus->peers, ElementsAre("10.0.0.1", "10.0.0.2"));
}

TEST(ServiceCommandLineTest, TheRoleIsThatOfTheProgramUnlessSaidOtherwise) {
  const config::ConfigFile none;
  const auto role_of = [&](const char* program, const std::string& role,
                           std::vector<const char*> options) {
    ServiceCommandLine command(program, "Does x.", "");
    options.insert(options.begin(), {program, "--security", "credentials"});
    EXPECT_EQ(command.Parse(static_cast<int>(options.size()), options.data()), std::nullopt);
    const auto bus = command.ReadBus(none, role);
    return bus.ok() ? bus->security_role : bus.error().message;
  };
  EXPECT_EQ(role_of("limbcast-fusion", "", {}), "fusion");
  EXPECT_EQ(role_of("limbcast", "", {}), "operator");
  EXPECT_EQ(role_of("limbcast", "pipeline", {}), "pipeline");
  EXPECT_EQ(role_of("limbcast", "pipeline", {"--security-role", "spectator"}), "spectator");
}

TEST(ServiceCommandLineTest, RefusalsNameTheOptionOrTheKeyAndTheLimit) {
  const auto vendor = BusOf(config::ConfigFile(), "--dds", "foo");
  ASSERT_FALSE(vendor.ok());
  EXPECT_THAT(vendor.error().message, HasSubstr("--dds"));
  const auto domain = BusOf(config::ConfigFile(), "--domain", "102");
  ASSERT_FALSE(domain.ok());
  EXPECT_THAT(domain.error().message, HasSubstr("[0, 101], is 102"));
  const config::ConfigFile file = File("[bus]\ndomain_id = 102\n");
  (void)BusOf(file);
  EXPECT_EQ(file.Finish().error().message, "t.toml:2: bus.domain_id must be in [0, 101], is 102");
  const config::ConfigFile wrong = File("[bus]\ndds = \"foo\"\n");
  (void)BusOf(wrong);
  EXPECT_THAT(wrong.Finish().error().message, HasSubstr("t.toml:2: bus.dds "));
}

TEST(ServiceCommandLineTest, TheLogGoesToStderrInTheNameOfTheProgram) {
  const auto previous = spdlog::default_logger();
  ServiceCommandLine command("limbcast-x", "Does x.", "  limbcast-x");
  const std::array<const char*, 3> argv{"limbcast-x", "--log-level", "warning"};
  ASSERT_EQ(command.Parse(3, argv.data()), std::nullopt);
  ::testing::internal::CaptureStderr();
  command.StartLog();
  spdlog::info("not this");
  spdlog::warn("a line");
  spdlog::default_logger()->flush();
  spdlog::set_default_logger(previous);
  const std::string text = ::testing::internal::GetCapturedStderr();
  EXPECT_THAT(text, HasSubstr("limbcast-x warning: a line\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

}  // namespace
}  // namespace limbcast::service
