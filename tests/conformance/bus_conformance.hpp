#pragma once

// What every bus promises, whatever carries it. Included by the test file that instantiates it for
// pairs of back ends. Every sample is an Example, so a reader can tell that it arrived intact.

#include <set>
#include <tuple>

#include "tests/conformance/bus_conformance_fixture.hpp"

namespace limbcast::conformance {

using body::SegmentFrame;
using body::SegmentState;
using roster::Command;
using roster::RosterEntry;
using sensing::CoilBurst;
using sensing::MargFrame;
using sensing::MargSample;

inline std::vector<std::uint32_t> Counting(std::uint32_t from, std::uint32_t count) {
  std::vector<std::uint32_t> numbers(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    numbers[i] = from + i;
  }
  return numbers;
}

TEST_P(BusConformance, EveryTopicArrivesToTheLastBit) {
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  std::apply(
      [&]<typename... Ts>(const Ts&...) {
        const auto round_trip = [&]<typename T>(bus::TypeTag<T>) {
          Collector<T> collector;
          const auto reader = Read(*bus, collector);
          Connect(*peer, collector);
          Write(*peer, std::string(bus::Topic<T>::kShortName), 3, 1, 7, 1);
          EXPECT_TRUE(collector.WaitForSample(3, 7)) << bus::Topic<T>::kShortName;
          EXPECT_TRUE(collector.AllIntact()) << bus::Topic<T>::kShortName;
        };
        (round_trip(bus::TypeTag<Ts>{}), ...);
      },
      bus::AllTopics{});
}

TEST_P(BusConformance, SixtyFourInstancesStayApartAndInOrder) {
  constexpr std::uint32_t kInstances = 64;
  constexpr std::uint32_t kRounds = 10;  // fewer than the history keeps, so none may be missing
  Collector<MargSample> collector;
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  const auto reader = Read(*bus, collector);
  Connect(*peer, collector);
  Write(*peer, "marg", 0, kInstances, 1, kRounds);
  ASSERT_TRUE(collector.WaitForCount(kInstances * kRounds));
  for (std::uint32_t key = 0; key < kInstances; ++key) {
    EXPECT_EQ(collector.SequencesOf(key), Counting(1, kRounds)) << "instance " << key;
  }
  EXPECT_TRUE(collector.AllIntact());
}

template <typename T>
void ExpectDisposeEachTime(Collector<T>& collector,
                           const std::function<void(const std::string&)>& ok) {
  const std::string topic(bus::Topic<T>::kShortName);
  for (std::uint32_t time = 1; time <= 3; ++time) {  // gone, back, gone again
    ok("write " + topic + " 30 2 " + std::to_string(time) + " 1 0");
    ASSERT_TRUE(collector.WaitForSample(30, time)) << topic;
    ASSERT_TRUE(collector.WaitForSample(31, time)) << topic;
    ok("dispose " + topic + " 30");
    EXPECT_TRUE(collector.WaitUntil([&](const auto&, const auto& disposed) {
      return disposed == std::vector<std::uint32_t>(time, 30);
    })) << topic
        << ", time " << time;
  }
}

TEST_P(BusConformance, DisposeNamesTheInstanceEachTime) {
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  const auto check = [&]<typename T>(bus::TypeTag<T>) {
    Collector<T> collector;
    const auto reader = Read(*bus, collector);
    Connect(*peer, collector);
    ExpectDisposeEachTime<T>(collector, [&](const std::string& line) { Ok(*peer, line); });
    EXPECT_EQ(reader->counters().disposed, 3U) << bus::Topic<T>::kShortName;
  };
  check(bus::TypeTag<MargSample>{});    // key of 8 bytes
  check(bus::TypeTag<CoilBurst>{});     // of 16
  check(bus::TypeTag<SegmentState>{});  // of three fields, and exclusive
  check(bus::TypeTag<RosterEntry>{});   // a state
}

TEST_P(BusConformance, InstanceZeroCanBeWrittenAndDisposed) {
  Collector<RosterEntry> collector;
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  const auto reader = Read(*bus, collector);
  Connect(*peer, collector);
  Write(*peer, "roster", 0, 1, 1, 1);
  ASSERT_TRUE(collector.WaitForSample(0, 1));
  Ok(*peer, "dispose roster 0");
  EXPECT_TRUE(collector.WaitUntil(
      [](const auto&, const auto& disposed) { return disposed == std::vector<std::uint32_t>{0}; }));
}

TEST_P(BusConformance, LateJoinerOfAStateGetsTheLastValueOfEachInstanceOnce) {
  constexpr std::uint32_t kInstances = 64;
  const auto peer = OpenPeer();
  Write(*peer, "roster", 0, kInstances, 1, 3);  // revisions 1 to 3
  Collector<RosterEntry> collector;
  const auto bus = OpenBus();
  const auto reader = Read(*bus, collector);
  ASSERT_TRUE(collector.WaitForCount(kInstances));
  Write(*peer, "roster", 500, 1, 1, 1);  // whatever else was on its way comes before this
  ASSERT_TRUE(collector.WaitForSample(500, 1));
  EXPECT_EQ(collector.received().size(), kInstances + 1);
  for (std::uint32_t key = 0; key < kInstances; ++key) {
    EXPECT_EQ(collector.SequencesOf(key), std::vector<std::uint32_t>{3}) << "instance " << key;
  }
  EXPECT_TRUE(collector.AllIntact());
}

TEST_P(BusConformance, LateJoinerOfAStateIsNotGivenWhatWasDisposed) {
  const auto peer = OpenPeer();
  Write(*peer, "roster", 1, 3, 1, 1);
  Ok(*peer, "dispose roster 2");
  Collector<RosterEntry> collector;
  const auto bus = OpenBus();
  const auto reader = Read(*bus, collector);
  ASSERT_TRUE(collector.WaitForCount(2));
  Write(*peer, "roster", 500, 1, 1, 1);
  ASSERT_TRUE(collector.WaitForSample(500, 1));
  EXPECT_TRUE(collector.SequencesOf(2).empty());
  EXPECT_EQ(collector.disposed(), std::vector<std::uint32_t>{}) << "it never knew the instance";
}

TEST_P(BusConformance, LateJoinerOfAStreamGetsNoMoreThanTheHistoryKeeps) {
  // Nothing by the specification, but Cyclone DDS repeats to a new reader what an earlier one has
  // not yet acknowledged. Either way it is recent and in order, and nothing counts as lost.
  constexpr std::uint32_t kOld = 40;
  const auto depth = static_cast<std::size_t>(bus::BusConfig().stream_depth);
  Collector<MargSample> early;
  Collector<MargSample> late;
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  const auto early_reader = Read(*bus, early);
  Connect(*peer, early);
  Write(*peer, "marg", 1, 1, 1, kOld, std::chrono::milliseconds(1));
  ASSERT_TRUE(early.WaitForSample(1, kOld));
  const auto late_reader = Read(*bus, late);
  Connect(*peer, late);
  Write(*peer, "marg", 1, 1, kOld + 1, 1);
  ASSERT_TRUE(late.WaitForSample(1, kOld + 1));
  const std::vector<std::uint32_t> got = late.SequencesOf(1);
  EXPECT_LE(got.size(), depth + 1);
  const auto count = static_cast<std::uint32_t>(got.size());
  EXPECT_EQ(got, Counting(kOld + 2 - count, count));
  EXPECT_EQ(late_reader->counters().lost, 0U) << "what came before it joined is not lost";
}

TEST_P(BusConformance, PartitionsSeparateAndAWildcardJoinsThem) {
  Collector<MargSample> in_a;
  Collector<MargSample> in_b;
  Collector<MargSample> in_all;
  const auto peer_a = OpenPeer({.partition = partition_ + "a"});
  const auto peer_b = OpenPeer({.partition = partition_ + "b"});
  const auto bus_a = OpenBus(partition_ + "a");
  const auto bus_b = OpenBus(partition_ + "b");
  const auto bus_all = OpenBus(partition_ + "*");
  const auto reader_a = Read(*bus_a, in_a);
  const auto reader_b = Read(*bus_b, in_b);
  const auto reader_all = Read(*bus_all, in_all);
  Connect(*peer_a, in_a);
  Connect(*peer_a, in_all);
  Connect(*peer_b, in_b);
  Connect(*peer_b, in_all);
  Write(*peer_a, "marg", 1, 1, 1, 10);
  Write(*peer_b, "marg", 2, 1, 1, 10);
  ASSERT_TRUE(in_a.WaitForSample(1, 10));
  ASSERT_TRUE(in_b.WaitForSample(2, 10));
  ASSERT_TRUE(in_all.WaitForSample(1, 10));
  ASSERT_TRUE(in_all.WaitForSample(2, 10));
  EXPECT_TRUE(in_a.SequencesOf(2).empty());
  EXPECT_TRUE(in_b.SequencesOf(1).empty());
  EXPECT_EQ(in_all.received().size(), 20U);
}

TEST_P(BusConformance, FifteenSensorsAtHundredHertzArriveWithoutAGap) {
  constexpr std::uint32_t kSensors = 15;
  constexpr std::uint32_t kRounds = 100;
  Collector<MargSample> collector;
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  const auto reader = Read(*bus, collector);
  Connect(*peer, collector);
  Write(*peer, "marg", 1, kSensors, 1, kRounds, std::chrono::milliseconds(10));
  ASSERT_TRUE(collector.WaitForCount(kSensors * kRounds));
  for (std::uint32_t key = 1; key <= kSensors; ++key) {
    EXPECT_EQ(collector.SequencesOf(key), Counting(1, kRounds)) << "sensor " << key;
  }
  EXPECT_EQ(reader->counters().lost, 0U);
  EXPECT_EQ(reader->counters().rejected, 0U);
}

TEST_P(BusConformance, BurstOfCommandsLosesNone) {
  constexpr std::uint32_t kCommands = 200;
  Collector<Command> collector;
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  const auto reader = Read(*bus, collector);
  Connect(*peer, collector);
  Write(*peer, "command", 1, 1, 1, kCommands);
  ASSERT_TRUE(collector.WaitForCount(kCommands));
  EXPECT_EQ(collector.SequencesOf(1), Counting(1, kCommands));
  EXPECT_TRUE(collector.AllIntact());
}

TEST_P(BusConformance, StrongerWriterIsHeardAloneAndTheWeakerTakesOverWhenItLeaves) {
  constexpr std::uint32_t kStrongFrom = 1'000'000;
  const auto from_strong = [](const Received& sample) { return sample.sequence >= kStrongFrom; };
  Collector<SegmentState> collector;
  const auto bus = OpenBus();
  const auto reader = Read(*bus, collector);
  const auto weak = OpenPeer({.strength = 5});
  Ok(*weak, "start segment_state 1 1 1 5000");
  ASSERT_TRUE(collector.WaitForCount(5));

  auto strong = OpenPeer({.strength = 20});
  Ok(*strong, "start segment_state 1 1 " + std::to_string(kStrongFrom) + " 5000");
  ASSERT_TRUE(collector.WaitUntil([&](const auto& received, const auto&) {
    return std::count_if(received.begin(), received.end(), from_strong) >= 50;
  }));
  const std::vector<Received> both = collector.received();
  const auto taken_over = std::find_if(both.begin(), both.end(), from_strong);
  EXPECT_TRUE(std::all_of(taken_over, both.end(), from_strong)) << "heard the weaker one between";

  EXPECT_EQ(reader->counters().lost, 0U) << "what a weaker writer says is not lost";

  const auto left_at = std::chrono::steady_clock::now();
  strong.reset();
  ASSERT_TRUE(collector.WaitUntil(
      [&](const auto& received, const auto&) { return !from_strong(received.back()); }));
  EXPECT_LT(std::chrono::steady_clock::now() - left_at, std::chrono::seconds(4));  // lease + 2 s
}

TEST_P(BusConformance, ReaderDestroyedInFullFlowIsNotCalledAgain) {
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  Collector<MargSample> warm;
  const auto warm_reader = Read(*bus, warm);
  Connect(*peer, warm);
  Ok(*peer, "start marg 1 4 1 500");
  for (int i = 0; i < 5; ++i) {
    auto collector = std::make_unique<Collector<MargSample>>();
    auto reader = Read(*bus, *collector);
    ASSERT_TRUE(collector->WaitForCount(10));
    reader.reset();
    collector.reset();  // a late call would touch freed memory (the sanitizers see it)
  }
  Ok(*peer, "stop marg");
}

TEST_P(BusConformance, BeyondABoundIsRefusedByName) {
  const auto bus = OpenBus();
  const auto writer = bus->MakeWriter<MargFrame>();
  ASSERT_TRUE(writer.ok());
  MargFrame frame;
  frame.samples.resize(sensing::kMaxSamplesPerFrame + 1);
  const Status written = (*writer)->Write(frame);
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().code, ErrorCode::kInvalidArgument);
  EXPECT_NE(written.error().message.find("samples"), std::string::npos) << written.error().message;
  EXPECT_EQ((*writer)->counters().samples, 0U);
}

}  // namespace limbcast::conformance
