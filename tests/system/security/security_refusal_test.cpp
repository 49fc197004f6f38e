// Credentials that are not there, out of date or somebody else's are refused in words, by every
// role's process and by both libraries.
#include <gmock/gmock.h>

#include "common/bus/bus_factory.hpp"
#include "common/bus/cyclone/cyclone_bus.hpp"
#include "common/bus/fastdds/fast_bus.hpp"
#include "tests/system/security/secure_peers.hpp"

namespace limbcast::security_test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using namespace test_support;
using ::testing::HasSubstr;

class SecurityRefusalTest : public ::testing::TestWithParam<bus::Vendor> {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    MakeCredentials(*folder_ / "ours");
    MakeCredentials(*folder_ / "expired", true);
    MakeCredentials(*folder_ / "foreign");
    // Each role with the permissions of the next one.
    fs::copy(*folder_ / "ours", *folder_ / "wrong-role", fs::copy_options::recursive);
    // Our authority, identities of another one.
    fs::copy(*folder_ / "ours", *folder_ / "mixed", fs::copy_options::recursive);
    const auto& roles = security::DefaultRoles();
    for (std::size_t i = 0; i < roles.size(); ++i) {
      const std::string role = roles[i].role;
      const std::string next = roles[(i + 1) % roles.size()].role;
      for (const std::string library : {"cyclone", "fast"}) {
        const auto replace = [&](const fs::path& target, const fs::path& source) {
          fs::copy_file(source, target, fs::copy_options::overwrite_existing);
        };
        replace(*folder_ / "wrong-role" / role / (library + ".p7s"),
                *folder_ / "ours" / next / (library + ".p7s"));
        for (const char* ending : {".pem", ".key"}) {
          replace(*folder_ / "mixed" / role / (library + ending),
                  *folder_ / "foreign" / role / (library + ending));
        }
      }
    }
    fs::create_directory(*folder_ / "empty");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  bus::BusConfig As(const std::string& credentials, const std::string& role) const {
    bus::BusConfig config;
    config.vendor = GetParam();
    config.domain_id = domain_;
    config.security_dir = *folder_ / credentials;
    config.security_role = role;
    return config;
  }
  // Without our own look at the credentials: what the library alone does.
  static Result<std::unique_ptr<bus::Bus>> OpenUnchecked(const bus::BusConfig& config) {
    return GetParam() == bus::Vendor::kFast ? bus::fastdds::OpenFast(config, {})
                                            : bus::cyclone::OpenCyclone(config, {});
  }

  static inline std::unique_ptr<TemporaryFolder> folder_;
  const std::uint32_t domain_ = OwnDomain();
};

TEST_P(SecurityRefusalTest, EveryRoleIsToldWhatIsWrongWithItsCredentials) {
  for (const security::RoleGrant& grant : security::DefaultRoles()) {
    SCOPED_TRACE(grant.role);
    const std::pair<const char*, const char*> cases[] = {{"empty", "has no credentials of role"},
                                                         {"none", "is no folder"},
                                                         {"expired", "has expired at"},
                                                         {"wrong-role", "the identity is"},
                                                         {"mixed", "was not signed by"}};
    for (const auto& [credentials, words] : cases) {
      const auto opened = bus::Open(As(credentials, grant.role));
      ASSERT_FALSE(opened.ok()) << credentials;
      EXPECT_THAT(opened.error().message, HasSubstr(words));
      EXPECT_NE(opened.error().code, ErrorCode::kUnavailable);
    }
  }
}

TEST_P(SecurityRefusalTest, TheLibraryRefusesThemToo) {
  for (const security::RoleGrant& grant : security::DefaultRoles()) {
    for (const char* credentials : {"empty", "expired", "wrong-role", "mixed"}) {
      const auto opened = OpenUnchecked(As(credentials, grant.role));
      EXPECT_FALSE(opened.ok()) << grant.role << ' ' << credentials;
    }
    const auto opened = OpenUnchecked(As("ours", grant.role));
    EXPECT_TRUE(opened.ok()) << grant.role << ": " << opened.error().message;
  }
}

TEST_P(SecurityRefusalTest, EveryProgramSaysSoInOneLine) {
  const std::string dds = GetParam() == bus::Vendor::kFast ? "fast" : "cyclone";
  for (const char* program :
       {"limbcast-gateway", "limbcast-fusion", "limbcast-posture", "limbcast-session"}) {
    for (const char* credentials : {"none", "expired", "mixed"}) {
      const Outcome outcome =
          RunToEnd({Program(program), "--dds", dds, "--domain", std::to_string(domain_),
                    "--security", *folder_ / credentials});
      EXPECT_EQ(outcome.status, 2) << Describe(outcome);
      EXPECT_THAT(outcome.errors, HasSubstr(std::string(program) + ": security: "));
      EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Dds, SecurityRefusalTest,
                         ::testing::Values(bus::Vendor::kCyclone, bus::Vendor::kFast),
                         [](const auto& test) {
                           return std::string(test.param == bus::Vendor::kFast ? "fast"
                                                                               : "cyclone");
                         });

}  // namespace
}  // namespace limbcast::security_test
