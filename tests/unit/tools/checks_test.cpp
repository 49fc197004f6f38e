// The checks of tools/ pass on this tree (CTest entries tools.check_*) and really fail on what they
// forbid: each test makes a small tree with one mistake.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"
#include "tools/process/child_process.hpp"

namespace limbcast {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

class ChecksTest : public ::testing::Test {
 protected:
  void Put(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((tree_ / path).parent_path());
    std::ofstream(tree_ / path) << text;
  }

  struct Outcome {
    int status = -1;
    std::string output;
  };
  [[nodiscard]] Outcome Run(const std::string& check) const {
    auto child = process::ChildProcess::Start(
        {.arguments = {LIMBCAST_SOURCE_DIR "/tools/" + check, "--root", tree_.string()}});
    if (!child) {
      return {.status = -1, .output = child.error().message};
    }
    const auto ended = child->Wait(60s);
    return {.status = ended ? ended->status : -1, .output = child->Output() + child->Errors()};
  }

  const test_support::TemporaryFolder temporary_;
  const std::filesystem::path tree_ = temporary_.path();
};

TEST_F(ChecksTest, LayersAllowWhatTheTableLists) {
  Put("common/base/time.hpp", "#include <chrono>\n");
  Put("common/math/so3.hpp", "#include <Eigen/Core>\n#include \"common/base/time.hpp\"\n");
  Put("services/fusion/main.cpp", "#include \"common/math/so3.hpp\"\n#include <CLI/CLI.hpp>\n");
  const Outcome outcome = Run("check_layers");
  EXPECT_EQ(outcome.status, 0) << outcome.output;
}

struct Forbidden {
  const char* name;
  const char* file;
  const char* included;
  const char* message;
};
void PrintTo(const Forbidden& forbidden, std::ostream* out) { *out << forbidden.name; }

class ForbiddenIncludeTest : public ChecksTest, public ::testing::WithParamInterface<Forbidden> {};

TEST_P(ForbiddenIncludeTest, FailsAndNamesFileAndLine) {
  const std::string file = GetParam().file;
  Put(file, std::string("#pragma once\n#include ") + GetParam().included + "\n");
  const Outcome outcome = Run("check_layers");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr(file + ":2: must not include "));
  EXPECT_THAT(outcome.output, HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Includes, ForbiddenIncludeTest,
    ::testing::Values(
        Forbidden{"RoomPointsBack", "common/math/x.hpp", "\"common/filters/filter.hpp\"",
                  "common/math may include base"},
        Forbidden{"MathWithAThread", "common/filters/x.hpp", "<thread>", "no clock, thread"},
        Forbidden{"MathWithAFile", "common/body/x.hpp", "<fstream>", "no clock, thread"},
        Forbidden{"DdsInAService", "services/fusion/x.hpp", "<dds/dds.h>",
                  "services/fusion may use"},
        Forbidden{"DdsInTheBusContract", "common/bus/x.hpp", "<fastdds/dds/domain/x.hpp>",
                  "common/bus may use"},
        Forbidden{"ServiceOfAService", "services/fusion/x.hpp", "\"services/posture/posture.hpp\"",
                  "a service never includes another service"},
        Forbidden{"ToolsFromARoom", "common/runtime/x.hpp", "\"tools/process/child_process.hpp\"",
                  "common/runtime may include base"},
        Forbidden{"EigenInBase", "common/base/x.hpp", "<Eigen/Core>", "no library"},
        Forbidden{"ParserOutsideConfig", "services/gateway/x.hpp", "<toml++/toml.h>",
                  "services/gateway may use"},
        Forbidden{"UnknownLibrary", "common/runtime/x.hpp", "<boost/asio.hpp>", "unknown library"},
        Forbidden{"RelativePath", "common/math/x.hpp", "\"so3.hpp\"", "from the repository root"},
        Forbidden{"UnknownRoom", "common/math/x.hpp", "\"common/utils/x.hpp\"", "no known room"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_F(ChecksTest, LayersFailOnAFileOutsideEveryRoom) {
  Put("common/utils/helpers.hpp", "#pragma once\n");
  const Outcome outcome = Run("check_layers");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, HasSubstr("common/utils/helpers.hpp: lies in no room"));
}

TEST_F(ChecksTest, LayersFailOnFoldersInACircle) {
  Put("services/fusion/a.hpp", "#include \"services/fusion/workers/b.hpp\"\n");
  Put("services/fusion/workers/b.hpp", "#include \"services/fusion/a.hpp\"\n");
  const Outcome outcome = Run("check_layers");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output,
              HasSubstr("services/fusion -> services/fusion/workers -> services/fusion"));
}

TEST_F(ChecksTest, LayersOfAnEmptyTreeAreAnError) { EXPECT_EQ(Run("check_layers").status, 2); }

TEST_F(ChecksTest, TestMirrorWantsATestForEachSource) {
  Put("common/math/so3.cpp", "");
  Put("services/fusion/main.cpp", "");
  EXPECT_THAT(Run("check_test_mirror").output,
              HasSubstr("common/math/so3.cpp: no test at tests/unit/common/math/so3_test.cpp"));
  EXPECT_EQ(Run("check_test_mirror").status, 1);

  Put("tests/unit/common/math/so3_test.cpp", "");
  EXPECT_EQ(Run("check_test_mirror").status, 0);
}

TEST_F(ChecksTest, RoomsWantAReadmeAndSmallFiles) {
  Put("common/math/so3.hpp", "#pragma once\n");
  EXPECT_THAT(Run("check_rooms").output, HasSubstr("common/math: has no README.md"));
  Put("common/math/README.md", "# math\n");
  EXPECT_EQ(Run("check_rooms").status, 0);

  std::string long_file;
  for (int i = 0; i < 401; ++i) {
    long_file += "//\n";
  }
  Put("common/math/long.hpp", long_file);
  EXPECT_EQ(Run("check_rooms").status, 1);
  EXPECT_THAT(Run("check_rooms").output, HasSubstr("common/math/long.hpp: has 401 lines"));
}

TEST_F(ChecksTest, DeployWantsFilesThatParseAndProgramsThatExist) {
  Put("deploy/config/fusion.toml", "[bus]\ndomain_id = 1\n");
  Put("deploy/sysctl/90-limbcast.conf", "net.core.rmem_max = 1\n");
  Put("deploy/systemd/limbcast-fusion.service", "[Service]\nExecStart=/usr/bin/limbcast-fusion\n");
  EXPECT_EQ(Run("check_deploy").status, 0) << Run("check_deploy").output;

  Put("deploy/config/fusion.toml", "[bus]\ndomain_id =\n");
  Put("deploy/dds/fastdds.xml", "<dds><profiles></dds>");
  Put("deploy/sysctl/90-limbcast.conf", "net.core.rmem_max=lots\n");
  Put("deploy/systemd/limbcast-fusion.service", "[Service]\nExecStart=/usr/bin/limbcast-fusio\n");
  Put("deploy/container/Containerfile", "COPY nothing /there\n");
  const Outcome outcome = Run("check_deploy");
  EXPECT_EQ(outcome.status, 1);
  for (const char* problem : {"fusion.toml: ", "fastdds.xml: ", "90-limbcast.conf:1: ",
                              "no program limbcast-fusio", "COPY of nothing"}) {
    EXPECT_THAT(outcome.output, HasSubstr(problem));
  }
}

TEST_F(ChecksTest, DeployOfAnEmptyTreeIsAnError) { EXPECT_EQ(Run("check_deploy").status, 2); }

}  // namespace
}  // namespace limbcast
