#include "common/bus/inproc/inproc_bus.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "tests/support/fake_clock.hpp"

namespace limbcast::bus::inproc {
namespace {

using body::SegmentState;
using roster::RosterEntry;
using sensing::MargSample;

class InprocBusTest : public ::testing::Test {
 protected:
  std::unique_ptr<Bus> MakeBusIn(const std::string& partition, std::int32_t strength = 10) {
    return MakeBus(hub_, {.partition = partition, .ownership_strength = strength},
                   [this](const BusEvent& event) { events_.push_back(event); });
  }
  template <typename T>
  static std::unique_ptr<Reader<T>> Listen(Bus& bus, std::vector<T>& heard) {
    return bus
        .MakeReader<T>(
            {.on_sample = [&heard](const T& value, const SampleInfo&) { heard.push_back(value); }})
        .value();
  }
  template <typename T>
  static std::unique_ptr<Writer<T>> Speak(Bus& bus) {
    return bus.MakeWriter<T>().value();
  }
  std::size_t CountOf(BusEventKind kind) const {
    return static_cast<std::size_t>(std::count_if(
        events_.begin(), events_.end(), [&](const BusEvent& e) { return e.kind == kind; }));
  }

  test_support::FakeClock clock_;
  std::vector<BusEvent> events_;
  std::shared_ptr<Hub> hub_ = MakeHub(&clock_);
  std::unique_ptr<Bus> bus_ = MakeBusIn("");
};

TEST_F(InprocBusTest, WriteRunsTheHandlerBeforeItReturnsOnTheSameThread) {
  std::thread::id thread;
  Time received_at;
  const auto reader =
      bus_->MakeReader<MargSample>({.on_sample = [&](const MargSample& s, const SampleInfo& info) {
        thread = std::this_thread::get_id();
        received_at = info.received_at;
        EXPECT_EQ(s.sequence, 5U);
      }});
  ASSERT_TRUE(Speak<MargSample>(*bus_)->Write({.sequence = 5}));
  EXPECT_EQ(thread, std::this_thread::get_id());
  EXPECT_EQ(received_at, clock_.Now());
}

TEST_F(InprocBusTest, SamplesArriveInOrderAtEveryReader) {
  std::vector<MargSample> a;
  std::vector<MargSample> b;
  const auto reader_a = Listen(*bus_, a);
  const auto other = MakeBusIn("");
  const auto reader_b = Listen(*other, b);
  const auto writer = Speak<MargSample>(*bus_);
  for (std::uint32_t i = 1; i <= 100; ++i) {
    ASSERT_TRUE(writer->Write({.sequence = i}));
  }
  ASSERT_EQ(a.size(), 100U);
  ASSERT_EQ(b.size(), 100U);
  for (std::uint32_t i = 0; i < 100; ++i) {
    EXPECT_EQ(a[i].sequence, i + 1);
  }
  EXPECT_EQ(writer->counters().samples, 100U);
  EXPECT_EQ(reader_a->counters().samples, 100U);
}

TEST_F(InprocBusTest, StreamsAreNotKeptForLateJoiners) {
  const auto writer = Speak<MargSample>(*bus_);
  ASSERT_TRUE(writer->Write({.sequence = 1}));
  std::vector<MargSample> heard;
  const auto reader = Listen(*bus_, heard);
  EXPECT_TRUE(heard.empty());
}

TEST_F(InprocBusTest, ALateJoinerGetsTheLastValueOfEachInstanceInTheOrderOfWriting) {
  const auto writer = Speak<RosterEntry>(*bus_);
  ASSERT_TRUE(writer->Write({.body_id = {1}, .revision = 1}));
  ASSERT_TRUE(writer->Write({.body_id = {2}, .revision = 1}));
  ASSERT_TRUE(writer->Write({.body_id = {1}, .revision = 2}));
  std::vector<RosterEntry> heard;
  const auto reader = Listen(*bus_, heard);
  ASSERT_EQ(heard.size(), 2U);
  EXPECT_EQ(heard[0].body_id.value, 2U);
  EXPECT_EQ(heard[1].revision, 2U);
}

TEST_F(InprocBusTest, ADisposedInstanceIsToldAndForgotten) {
  std::vector<std::uint32_t> disposed;
  const auto reader = bus_->MakeReader<RosterEntry>(
      {.on_disposed = [&](const RosterEntry& key) { disposed.push_back(key.body_id.value); }});
  const auto writer = Speak<RosterEntry>(*bus_);
  ASSERT_TRUE(writer->Write({.body_id = {1}}));
  ASSERT_TRUE(writer->Write({.body_id = {2}}));
  ASSERT_TRUE(writer->Dispose({.body_id = {1}}));
  ASSERT_TRUE(writer->Dispose({.body_id = {1}}));  // gone already
  ASSERT_TRUE(writer->Dispose({.body_id = {3}}));  // never heard of
  EXPECT_EQ(disposed, std::vector<std::uint32_t>{1});
  EXPECT_EQ((*reader)->counters().disposed, 1U);
  std::vector<RosterEntry> late;
  const auto late_reader = Listen(*bus_, late);
  ASSERT_EQ(late.size(), 1U);
  EXPECT_EQ(late[0].body_id.value, 2U);
}

TEST_F(InprocBusTest, WhatADestroyedWriterWroteIsNotReplayed) {
  auto writer = Speak<RosterEntry>(*bus_);
  ASSERT_TRUE(writer->Write({.body_id = {1}}));
  writer.reset();
  std::vector<RosterEntry> heard;
  const auto reader = Listen(*bus_, heard);
  EXPECT_TRUE(heard.empty());
}

TEST_F(InprocBusTest, PartitionsAreSeparateUnlessAWildcardJoinsThem) {
  const auto hall = MakeBusIn("hall");
  const auto studio = MakeBusIn("studio");
  const auto monitor = MakeBusIn("*");
  std::vector<MargSample> in_studio;
  std::vector<MargSample> in_monitor;
  const auto reader = Listen(*studio, in_studio);
  const auto monitor_reader = Listen(*monitor, in_monitor);
  ASSERT_TRUE(Speak<MargSample>(*hall)->Write({}));
  ASSERT_TRUE(Speak<MargSample>(*studio)->Write({}));
  EXPECT_EQ(in_studio.size(), 1U);
  EXPECT_EQ(in_monitor.size(), 2U);
}

TEST_F(InprocBusTest, OnlyTheStrongestWriterOfAnInstanceIsHeard) {
  const auto strong_bus = MakeBusIn("", 20);
  std::vector<SegmentState> heard;
  const auto reader = Listen(*bus_, heard);
  const auto weak = Speak<SegmentState>(*bus_);
  auto strong = Speak<SegmentState>(*strong_bus);
  ASSERT_TRUE(weak->Write({.body_id = {1}, .sequence = 1}));  // nobody stronger wrote body 1 yet
  ASSERT_TRUE(strong->Write({.body_id = {1}, .sequence = 2}));
  ASSERT_TRUE(weak->Write({.body_id = {1}, .sequence = 3}));  // not heard
  ASSERT_TRUE(weak->Write({.body_id = {2}, .sequence = 4}));  // another instance
  strong.reset();
  ASSERT_TRUE(weak->Write({.body_id = {1}, .sequence = 5}));
  std::vector<std::uint32_t> sequences;
  for (const SegmentState& state : heard) {
    sequences.push_back(state.sequence);
  }
  EXPECT_EQ(sequences, (std::vector<std::uint32_t>{1, 2, 4, 5}));
}

TEST_F(InprocBusTest, SharedTopicsHearEveryWriter) {
  const auto strong_bus = MakeBusIn("", 20);
  std::vector<MargSample> heard;
  const auto reader = Listen(*bus_, heard);
  ASSERT_TRUE(Speak<MargSample>(*strong_bus)->Write({}));
  ASSERT_TRUE(Speak<MargSample>(*bus_)->Write({}));
  EXPECT_EQ(heard.size(), 2U);
}

TEST_F(InprocBusTest, BoundsAreThoseOfTheWire) {
  const auto writer = Speak<RosterEntry>(*bus_);
  const Status refused = writer->Write({.session = std::string(65, 's')});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "roster.session has 65 characters, at most 64 are allowed");
  EXPECT_EQ(writer->counters().samples, 0U);
}

TEST_F(InprocBusTest, MatchingIsCountedAndTold) {
  std::vector<MargSample> heard;
  auto reader = Listen(*bus_, heard);
  auto writer = Speak<MargSample>(*bus_);
  EXPECT_EQ(writer->counters().matched, 1);
  EXPECT_EQ(reader->counters().matched, 1);
  EXPECT_EQ(reader->counters().alive_writers, 1);
  EXPECT_EQ(CountOf(BusEventKind::kMatched), 2U);
  EXPECT_EQ(CountOf(BusEventKind::kLivelinessGained), 1U);
  writer.reset();
  EXPECT_EQ(reader->counters().matched, 0);
  EXPECT_EQ(reader->counters().alive_writers, 0);
  EXPECT_EQ(CountOf(BusEventKind::kUnmatched), 1U);
  writer = Speak<MargSample>(*bus_);
  reader.reset();
  EXPECT_EQ(writer->counters().matched, 0);
}

TEST_F(InprocBusTest, AHandlerThatWritesToItsOwnTopicIsCalledAgainAfterwards) {
  const auto writer = Speak<MargSample>(*bus_);
  std::vector<std::uint32_t> order;
  const auto reader =
      bus_->MakeReader<MargSample>({.on_sample = [&](const MargSample& s, const SampleInfo&) {
        order.push_back(s.sequence);
        if (s.sequence < 3) {
          ASSERT_TRUE(writer->Write({.sequence = s.sequence + 1}));
          order.push_back(100 + s.sequence);  // before the next call, not inside it
        }
      }});
  ASSERT_TRUE(writer->Write({.sequence = 1}));
  EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 101, 2, 102, 3}));
}

TEST_F(InprocBusTest, AHandlerMayWriteToOtherTopics) {
  const auto states = Speak<SegmentState>(*bus_);
  std::vector<SegmentState> heard;
  const auto state_reader = Listen(*bus_, heard);
  const auto reader =
      bus_->MakeReader<MargSample>({.on_sample = [&](const MargSample& s, const SampleInfo&) {
        ASSERT_TRUE(states->Write({.sequence = s.sequence}));
      }});
  ASSERT_TRUE(Speak<MargSample>(*bus_)->Write({.sequence = 9}));
  ASSERT_EQ(heard.size(), 1U);
  EXPECT_EQ(heard[0].sequence, 9U);
}

TEST_F(InprocBusTest, WritersOnManyThreadsLoseNothingAndOneCallRunsAtATime) {
  constexpr int kThreads = 4;
  constexpr int kEach = 2000;
  std::atomic<int> inside{0};
  std::atomic<int> most_inside{0};
  std::atomic<int> heard{0};
  const auto reader =
      bus_->MakeReader<MargSample>({.on_sample = [&](const MargSample&, const SampleInfo&) {
        const int now = ++inside;
        most_inside = std::max(most_inside.load(), now);
        ++heard;
        --inside;
      }});
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([this] {
        const auto writer = Speak<MargSample>(*bus_);
        for (int i = 0; i < kEach; ++i) {
          ASSERT_TRUE(writer->Write({}));
        }
      });
    }
  }
  EXPECT_EQ(heard, kThreads * kEach);
  EXPECT_EQ(most_inside, 1);
}

TEST_F(InprocBusTest, AfterAReaderIsDestroyedItsHandlerNeverRuns) {
  std::atomic<bool> alive{true};
  std::atomic<bool> stop{false};
  std::atomic<int> calls{0};
  auto reader = bus_->MakeReader<MargSample>({.on_sample =
                                                  [&](const MargSample&, const SampleInfo&) {
                                                    EXPECT_TRUE(alive);
                                                    ++calls;
                                                  }})
                    .value();
  std::jthread writing([&] {
    const auto writer = Speak<MargSample>(*bus_);
    while (!stop) {
      ASSERT_TRUE(writer->Write({}));
    }
  });
  while (calls < 100) {
    std::this_thread::yield();
  }
  reader.reset();
  alive = false;
  stop = true;
}

TEST_F(InprocBusTest, ABusThatIsGoneHearsNoEvents) {
  auto going = MakeBusIn("");
  going.reset();
  events_.clear();
  const auto writer = Speak<MargSample>(*bus_);
  EXPECT_TRUE(events_.empty());
}

}  // namespace
}  // namespace limbcast::bus::inproc
