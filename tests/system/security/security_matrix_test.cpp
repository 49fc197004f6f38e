// Who may do what on a secured network, every role on every topic, and what is left to strangers.
//
// Nothing here waits for time to pass: a refusal is looked at once a permitted match of the same
// participants, or of the same kind of strangers, has shown that discovery is through.
#include <gmock/gmock.h>

#include <string>
#include <tuple>

#include "tests/system/security/secure_peers.hpp"

namespace limbcast::security_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using namespace test_support;

constexpr std::uint32_t kHubKey = 1;
constexpr std::uint32_t kFriendKey = 2;
constexpr std::uint32_t kStrangerKey = 3;

// One library for the hub, which may do everything, and one for who meets it.
class SecurityMatrixTest : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    MakeCredentials(*folder_ / "ours");
    MakeCredentials(*folder_ / "foreign");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  [[nodiscard]] static std::string Ours() { return *folder_ / "ours"; }
  [[nodiscard]] static std::string Foreign() { return *folder_ / "foreign"; }
  void SetUp() override {
    ASSERT_THAT(hub_.Open(HubVendor(), domain_, Ours(), kEverything, kHubKey), StartsWith("ok"));
    (void)hub_.MakeEndpoints();
  }
  [[nodiscard]] static std::string HubVendor() { return std::get<0>(GetParam()); }
  [[nodiscard]] static std::string OtherVendor() { return std::get<1>(GetParam()); }

  // Waits until both have exactly the peers that they may have.
  static void ExpectPeers(SecureBus& one, const Counts& expected) {
    std::string difference;
    EXPECT_TRUE(Eventually(kDeadline,
                           [&] {
                             difference = Difference(one.Now(), expected);
                             return difference.empty();
                           }))
        << one.name() << ": " << difference;
  }

  // Both write until each has heard the other on every topic it may.
  static void ExpectData(SecureBus& one, const security::RoleGrant& one_may, SecureBus& other,
                         const security::RoleGrant& other_may) {
    const Counts one_before = one.Now();
    const Counts other_before = other.Now();
    std::string missing;
    EXPECT_TRUE(Eventually(kDeadline, [&] {
      one.Write();
      other.Write();
      Counts one_now = one.Now();
      Counts other_now = other.Now();
      missing.clear();
      for (const std::string& topic : security::TopicNames()) {
        if (Has(one_may.subscribe, topic) && Has(other_may.publish, topic) &&
            one_now[topic].of_others == one_before.at(topic).of_others) {
          missing += one.name() + " hears no " + topic + "; ";
        }
        if (Has(other_may.subscribe, topic) && Has(one_may.publish, topic) &&
            other_now[topic].of_others == other_before.at(topic).of_others) {
          missing += other.name() + " hears no " + topic + "; ";
        }
      }
      return missing.empty();
    })) << missing;
  }

  static inline std::unique_ptr<TemporaryFolder> folder_;
  const std::uint32_t domain_ = OwnDomain();
  SecureBus hub_{"hub"};
};

// What a library makes of a role's permissions, before anybody else is asked.
void ExpectEndpoints(SecureBus& bus, const security::RoleGrant& grant) {
  const std::set<std::string> made = bus.MakeEndpoints();
  for (const std::string& topic : security::TopicNames()) {
    const bool may_publish = Has(grant.publish, topic);
    const bool may_subscribe = Has(grant.subscribe, topic);
    EXPECT_EQ(made.count("+w:" + topic), may_publish) << grant.role << ' ' << topic;
    EXPECT_EQ(made.count("+r:" + topic), may_subscribe) << grant.role << ' ' << topic;
    if (!may_publish) {
      EXPECT_THAT(bus.Why("w:" + topic), HasSubstr("may not publish " + topic));
    }
    if (!may_subscribe) {
      EXPECT_THAT(bus.Why("r:" + topic), HasSubstr("may not subscribe " + topic));
    }
  }
}

TEST_P(SecurityMatrixTest, EveryRoleDoesWhatItIsGrantedAndNoMore) {
  const security::RoleGrant all = GrantOf(kEverything);
  ExpectPeers(hub_, Expected(all, {}));
  SecureBus bearer("bearer");
  for (const security::RoleGrant& grant : security::DefaultRoles()) {
    SCOPED_TRACE(grant.role);
    ASSERT_THAT(bearer.Open(OtherVendor(), domain_, Ours(), grant.role, kFriendKey),
                StartsWith("ok"));
    ExpectEndpoints(bearer, grant);
    ExpectPeers(bearer, Expected(grant, {all}));
    ExpectPeers(hub_, Expected(all, {grant}));
    ExpectData(hub_, all, bearer, grant);
    bearer.Close();
    ExpectPeers(hub_, Expected(all, {}));
    if (HasFailure()) {
      break;
    }
  }
}

TEST_P(SecurityMatrixTest, StrangersNeitherHearNorReachAnybody) {
  const security::RoleGrant all = GrantOf(kEverything);
  SecureBus our_control("our-control");
  const auto start = [&](SecureBus& bus, const std::string& folder, std::uint32_t key) {
    ASSERT_THAT(bus.Open(OtherVendor(), domain_, folder, kEverything, key), StartsWith("ok"));
    (void)bus.MakeEndpoints();
  };
  start(our_control, Ours(), kFriendKey);
  ExpectPeers(hub_, Expected(all, {all}));
  // Strangers of each kind, and for each kind one more that has to find them. A process each: with
  // Cyclone DDS 0.10, participants of several identities in one process hear nobody outside.
  std::vector<SecureBus> foreigners;
  for (const security::RoleGrant& grant : security::DefaultRoles()) {
    SecureBus& foreigner = foreigners.emplace_back("foreign-" + grant.role);
    ASSERT_THAT(foreigner.Open(OtherVendor(), domain_, Foreign(), grant.role, kStrangerKey),
                StartsWith("ok"));
    (void)foreigner.MakeEndpoints();
  }
  SecureBus foreign_control("foreign-control");
  SecureBus bare("bare");
  SecureBus bare_control("bare-control");
  start(foreign_control, Foreign(), kStrangerKey + 1);
  start(bare, "-", kStrangerKey + 2);
  start(bare_control, "-", kStrangerKey + 3);

  // Positive events: everybody has found their like.
  ExpectPeers(hub_, Expected(all, {all}));
  ExpectPeers(our_control, Expected(all, {all}));
  ExpectPeers(foreign_control, Expected(all, security::DefaultRoles()));
  ExpectPeers(bare, Expected(all, {all}));
  ExpectPeers(bare_control, Expected(all, {all}));
  ExpectData(hub_, all, our_control, all);
  ExpectData(bare, all, bare_control, all);
  ExpectData(foreign_control, all, foreigners[0], security::DefaultRoles()[0]);

  // And nobody else, on either side.
  for (SecureBus* known : {&hub_, &our_control, &bare, &bare_control}) {
    EXPECT_EQ(Difference(known->Now(), Expected(all, {all})), "") << known->name();
  }
  EXPECT_EQ(Difference(foreign_control.Now(), Expected(all, security::DefaultRoles())), "");
  EXPECT_EQ(hub_.Keys(), "ok 1 2 ");
  EXPECT_EQ(our_control.Keys(), "ok 1 2 ");
  EXPECT_EQ(bare.Keys(), "ok 5 6 ");
  EXPECT_EQ(bare_control.Keys(), "ok 5 6 ");
  EXPECT_THAT(foreign_control.Keys(), StartsWith("ok 3 4 "));
}

INSTANTIATE_TEST_SUITE_P(HubAndOther, SecurityMatrixTest,
                         ::testing::Combine(::testing::Values("cyclone", "fast"),
                                            ::testing::Values("cyclone", "fast")),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param)) + "_" +
                                  std::get<1>(test.param);
                         });

}  // namespace
}  // namespace limbcast::security_test
