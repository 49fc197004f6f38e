#include "services/gateway/driver_factory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace limbcast::gateway {
namespace {

using ::testing::HasSubstr;

DriverConfigs Read(const std::string& text) {
  const Result<config::ConfigFile> file = config::ConfigFile::Parse(text, "g.toml");
  Expects(file.ok(), "a file that parses");
  const DriverConfigs configs = ReadDriverConfigs(*file);
  Expects(file->Finish().ok(), "a file without mistakes");
  return configs;
}

TEST(DriverFactoryTest, MakesTheSimulator) {
  const auto driver = MakeDriver("simulator", Read("[simulator]\npersons = 2\n"));
  ASSERT_TRUE(driver.ok()) << driver.error().message;
  EXPECT_EQ((*driver)->Describe().driver, "simulator");
  EXPECT_EQ((*driver)->Describe().bodies.size(), 2U);
  EXPECT_GE((*driver)->Describe().sensors.size(), 30U);
}

TEST(DriverFactoryTest, UnknownDriverNamesTheKnownOnes) {
  EXPECT_EQ(MakeDriver("sorcery", {}).error().message,
            "gateway.driver must be simulator or replay, is sorcery");
}

TEST(DriverFactoryTest, ReplayNeedsARecordingThatIsThere) {
  EXPECT_THAT(MakeDriver("replay", {}).error().message, HasSubstr("replay.recording is not set"));
  EXPECT_EQ(MakeDriver("replay", Read("[replay]\nrecording = \"/nowhere\"\n")).error().code,
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace limbcast::gateway
