// Clients of a real session host, on a bus inside this process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/bus/inproc/inproc_bus.hpp"
#include "common/client/client.hpp"
#include "common/runtime/system_clock.hpp"
#include "common/runtime/thread_pool.hpp"
#include "services/session/session_service.hpp"
#include "tests/support/temporary_folder.hpp"

namespace limbcast::client {
namespace {

using namespace std::chrono_literals;
using roster::Role;
using ::testing::HasSubstr;

class ClientSessionTest : public ::testing::Test {
 protected:
  ClientSessionTest() { StartHost(); }
  ~ClientSessionTest() override { StopHost(); }

  std::unique_ptr<bus::Bus> In(const std::string& partition) const {
    bus::BusConfig config;
    config.partition = partition;
    return bus::inproc::MakeBus(hub_, config);
  }
  void StartHost() {
    session::SessionConfig config;
    config.sessions = {"stage"};
    config.state_dir = folder_.path().string();
    lobby_ = In("");
    pool_ = std::make_unique<runtime::ThreadPool>("session", 1);
    host_ = std::make_unique<session::SessionService>(
        config, clock_, *lobby_,
        [this](const std::string& partition) -> Result<std::unique_ptr<bus::Bus>> {
          return In(partition);
        },
        *pool_);
    ASSERT_TRUE(host_->Start().ok());
  }
  void StopHost() {
    host_.reset();
    pool_.reset();
    lobby_.reset();
  }
  static ClientOptions As(Role role, const std::string& person) {
    ClientOptions options;
    options.session = "stage";
    options.role = role;
    options.person = person;
    options.join_timeout = 10s;
    return options;
  }
  static ClientOptions Performer(const std::string& person, std::uint64_t uid) {
    ClientOptions options = As(Role::kPerformer, person);
    options.sensors = {{.sensor_uid = {uid}, .segment = body::Segment::kHead}};
    return options;
  }
  template <typename Condition>
  static bool Eventually(Condition condition) {
    const auto until = std::chrono::steady_clock::now() + 10s;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > until) {
        return false;
      }
      std::this_thread::yield();
    }
    return true;
  }

  const test_support::TemporaryFolder folder_;
  const runtime::SystemClock clock_;
  std::shared_ptr<bus::inproc::Hub> hub_ = bus::inproc::MakeHub();
  std::unique_ptr<bus::Bus> lobby_;
  std::unique_ptr<runtime::ThreadPool> pool_;
  std::unique_ptr<session::SessionService> host_;
  std::unique_ptr<bus::Bus> bus_ = In("stage");
};

TEST_F(ClientSessionTest, EverybodySeesWhoIsThere) {
  const auto ada = Client::Attach(*bus_, clock_, Performer("Ada", 11));
  ASSERT_TRUE(ada.ok()) << ada.error().message;
  EXPECT_EQ((*ada)->Standing(), (SessionStanding{.member = true, .body_id = {1}, .message = ""}));
  {
    const auto bob = Client::Attach(*bus_, clock_, Performer("Bob", 12));
    const auto guest = Client::Attach(*bus_, clock_, As(Role::kSpectator, "guest"));
    ASSERT_TRUE(bob.ok() && guest.ok());
    EXPECT_EQ((*guest)->Standing().body_id.value, 0U);
    EXPECT_EQ((*guest)->Entry({1})->person, "Ada");
    EXPECT_EQ((*ada)->Entry({2})->person, "Bob");
  }
  EXPECT_TRUE(Eventually([&] { return !(*ada)->Entry({2}); })) << "Bob left in good order";
}

TEST_F(ClientSessionTest, ARestartOfTheHostIsNotNoticed) {
  const auto ada = Client::Attach(*bus_, clock_, Performer("Ada", 11));
  ASSERT_TRUE(ada.ok());
  std::atomic<int> changes{0};
  (*ada)->OnStanding([&](const SessionStanding&) { ++changes; });
  StopHost();
  StartHost();
  const auto bob = Client::Attach(*bus_, clock_, Performer("Bob", 12));
  ASSERT_TRUE(bob.ok()) << bob.error().message;
  EXPECT_EQ((*bob)->Standing().body_id.value, 2U);
  ASSERT_TRUE(Eventually([&] { return (*bob)->Entry({1}).has_value(); }));
  EXPECT_EQ((*bob)->Entry({1})->person, "Ada");
  EXPECT_EQ(changes, 0);
  (*ada)->OnStanding({});
}

TEST_F(ClientSessionTest, AnOperatorSendsAwayAndEndsTheSession) {
  const auto ada = Client::Attach(*bus_, clock_, Performer("Ada", 11));
  const auto boss = Client::Attach(*bus_, clock_, As(Role::kOperator, "boss"));
  ASSERT_TRUE(ada.ok() && boss.ok());
  EXPECT_THAT((*ada)->CloseSession().error().message, HasSubstr("only an operator"));
  EXPECT_THAT((*boss)->ReleasePerson("Eve").error().message, HasSubstr("\"Eve\" is not in"));
  EXPECT_TRUE((*boss)->ReleasePerson("Ada").ok());
  EXPECT_TRUE((*boss)->CloseSession().ok());
  EXPECT_TRUE(Eventually([&] { return !(*ada)->Standing().member; }));
  EXPECT_THAT((*ada)->Standing().message, HasSubstr("there is no session \"stage\""));
}

TEST_F(ClientSessionTest, WhatCannotBeFailsWithTheHostsReason) {
  ClientOptions nobody = As(Role::kPerformer, "Ada");
  nobody.join_timeout = 2s;  // the room may open after the first request
  const auto refused = Client::Attach(*bus_, clock_, nobody);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("at least one sensor"));
  const auto outside = Client::Attach(*bus_, clock_);
  EXPECT_TRUE((*outside)->Standing().member);
  EXPECT_THAT((*outside)->CloseSession().error().message, HasSubstr("in no session"));
}

}  // namespace
}  // namespace limbcast::client
