#include "services/gateway/coil_grants.hpp"

#include <gtest/gtest.h>

#include "common/bus/inproc/inproc_bus.hpp"

namespace limbcast::gateway {
namespace {

using namespace std::chrono_literals;

class CoilGrantsTest : public ::testing::Test {
 protected:
  void Write(std::uint32_t body, std::uint32_t slot, std::uint32_t slots = 2,
             std::uint32_t frame_us = 200'000) {
    roster::RosterEntry entry;
    entry.body_id = {body};
    entry.revision = ++revision_;
    entry.coil_slot = slot;
    entry.coil_slots = slots;
    entry.coil_frame_us = frame_us;
    EXPECT_TRUE(writer_->Write(entry).ok());
    writer_->Flush();
  }
  std::unique_ptr<CoilGrants> Make(std::vector<BodyId> own) {
    auto grants = CoilGrants::Make(*bus_, std::move(own));
    EXPECT_TRUE(grants);
    return std::move(*grants);
  }

  std::unique_ptr<bus::Bus> bus_ = bus::inproc::MakeBus(bus::inproc::MakeHub());
  std::unique_ptr<bus::Writer<roster::RosterEntry>> writer_ =
      *bus_->MakeWriter<roster::RosterEntry>();
  std::uint32_t revision_ = 0;
};

TEST_F(CoilGrantsTest, NobodyPulsesBeforeTheRosterGrantsIt) {
  const auto grants = Make({BodyId{1}});
  ASSERT_EQ(grants->schedule()->own.size(), 1U);
  EXPECT_FALSE(grants->schedule()->Of({1}));
  Write(1, 2);
  const auto schedule = grants->schedule();
  EXPECT_EQ(schedule->Of({1}), (sensing::CoilGrant{.slot = 1, .slots = 2, .frame = 200ms}));
  EXPECT_TRUE(schedule->foreign.empty());
  Write(1, 2);
  EXPECT_EQ(grants->schedule(), schedule) << "the same again is no news";
}

TEST_F(CoilGrantsTest, WhatOthersAreGrantedIsForeign) {
  Write(7, 1);  // before us
  const auto grants = Make({BodyId{1}, BodyId{2}});
  Write(1, 2);
  Write(2, 0, 0, 0);
  const auto schedule = grants->schedule();
  EXPECT_EQ(schedule->foreign, (std::vector{sensing::CoilGrant{.slot = 0, .slots = 2}}));
  EXPECT_TRUE(schedule->Of({1}));
  EXPECT_FALSE(schedule->Of({2}));
}

TEST_F(CoilGrantsTest, AGrantEndsWithItsEntryOrWhenItIsTakenBack) {
  const auto grants = Make({BodyId{1}});
  Write(1, 1);
  Write(7, 2);
  roster::RosterEntry gone;
  gone.body_id = {7};
  EXPECT_TRUE(writer_->Dispose(gone).ok());
  EXPECT_TRUE(grants->schedule()->foreign.empty());
  EXPECT_TRUE(grants->schedule()->Of({1}));
  Write(1, 0);
  EXPECT_FALSE(grants->schedule()->Of({1}));
}

TEST_F(CoilGrantsTest, OfTwoInOneSlotTheFirstBodyKeepsIt) {
  const auto grants = Make({BodyId{5}});
  Write(5, 1);
  Write(7, 1);
  EXPECT_TRUE(grants->schedule()->Of({5}));
  Write(3, 1);
  EXPECT_FALSE(grants->schedule()->Of({5}));
  Write(3, 2);
  EXPECT_TRUE(grants->schedule()->Of({5}));
}

TEST_F(CoilGrantsTest, WhatIsNoGrantGrantsNothing) {
  const auto grants = Make({BodyId{1}});
  Write(1, 3, 2);  // of two slots the third
  EXPECT_FALSE(grants->schedule()->Of({1}));
  Write(1, 1, 4'000'000, 1'000);  // slots of no length
  EXPECT_FALSE(grants->schedule()->Of({1}));
  Write(1, 1, 1, 0);
  EXPECT_FALSE(grants->schedule()->Of({1}));
}

}  // namespace
}  // namespace limbcast::gateway
