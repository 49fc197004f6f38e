#include "common/client/session_directory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "common/bus/inproc/inproc_bus.hpp"

namespace limbcast::client {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SessionDirectoryTest : public ::testing::Test {
 protected:
  void StartHost() {
    states_ = *bus_->MakeWriter<roster::SessionState>();
    replies_ = *bus_->MakeWriter<roster::CommandReply>();
    commands_ = *bus_->MakeReader<roster::Command>(
        {.on_sample =
             [this](const roster::Command& command, const bus::SampleInfo&) {
               if (command.kind == roster::CommandKind::kCountSessions) {
                 counted_ += 1;
                 EXPECT_TRUE(replies_
                                 ->Write({.client_uid = command.client_uid,
                                          .request_id = command.request_id,
                                          .accepted = true,
                                          .message = count_})
                                 .ok());
                 return;
               }
               EXPECT_EQ(command.kind, roster::CommandKind::kCreateSession);
               const bool plain = command.text.find('*') == std::string::npos;
               EXPECT_TRUE(replies_
                               ->Write({.client_uid = command.client_uid,
                                        .request_id = command.request_id,
                                        .accepted = plain,
                                        .message = plain ? "done" : "a pattern"})
                               .ok());
             },
         .on_disposed = {}});
  }
  void Tell(std::uint32_t id, const std::string& name) {
    roster::SessionState state;
    state.session_id = id;
    state.name = name;
    ASSERT_TRUE(states_->Write(state).ok());
  }
  static auto Named(const std::string& name) { return Field(&roster::SessionState::name, name); }

  std::string count_;  // what the host says to how many sessions there are
  std::atomic<int> counted_ = 0;
  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(bus::inproc::MakeHub());
  std::unique_ptr<bus::Writer<roster::SessionState>> states_;
  std::unique_ptr<bus::Writer<roster::CommandReply>> replies_;
  std::unique_ptr<bus::Reader<roster::Command>> commands_;
};

TEST_F(SessionDirectoryTest, TellsWhatSessionsThereAre) {
  StartHost();
  Tell(2, "studio");
  const auto directory = SessionDirectory::Attach(*bus_);
  ASSERT_TRUE(directory.ok());
  EXPECT_TRUE((*directory)->WaitForHost(0s).ok());
  Tell(1, "theatre");
  Tell(3, "stage");
  EXPECT_THAT((*directory)->Sessions(),
              ElementsAre(Named("stage"), Named("studio"), Named("theatre")));
  roster::SessionState closed;
  closed.session_id = 2;
  ASSERT_TRUE(states_->Dispose(closed).ok());
  EXPECT_THAT((*directory)->Sessions(), ElementsAre(Named("stage"), Named("theatre")));
}

TEST_F(SessionDirectoryTest, AListWaitsForAsManyAsTheHostHas) {
  StartHost();
  Tell(2, "studio");
  count_ = "2";
  const auto directory = SessionDirectory::Attach(*bus_);
  std::thread late([this] {
    while (counted_ == 0) {
      std::this_thread::yield();
    }
    Tell(1, "theatre");
  });
  const auto sessions = (*directory)->List(10s);
  late.join();
  ASSERT_TRUE(sessions.ok()) << sessions.error().message;
  EXPECT_THAT(*sessions, ElementsAre(Named("studio"), Named("theatre")));
  count_ = "3";
  const auto short_of_one = (*directory)->List(1ms);
  ASSERT_FALSE(short_of_one.ok());
  EXPECT_EQ(short_of_one.error().code, ErrorCode::kTimeout);
  EXPECT_THAT(short_of_one.error().message, HasSubstr("\"3\" to how many sessions it has, and 2"));
}

TEST_F(SessionDirectoryTest, CreatesAndPassesOnTheReasonOfARefusal) {
  StartHost();
  const auto directory = SessionDirectory::Attach(*bus_);
  EXPECT_TRUE((*directory)->Create("stage").ok());
  const Status refused = (*directory)->Create("st*");
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(refused.error().message, "a pattern");
}

TEST_F(SessionDirectoryTest, WithoutAHostItSaysSo) {
  const auto directory = SessionDirectory::Attach(*bus_);
  EXPECT_THAT((*directory)->Sessions(), IsEmpty());
  EXPECT_THAT((*directory)->Create("stage", 1ms).error().message, HasSubstr("no session host"));
  ClientOptions options;
  options.dds = "carrier-pigeon";
  EXPECT_EQ(SessionDirectory::Connect(options).error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace limbcast::client
