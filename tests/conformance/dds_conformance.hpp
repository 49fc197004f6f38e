#pragma once

// The rest of what a bus on a network promises: what can only go wrong between two participants.
// Every case also runs with the writer in a process of its own.

#include "tests/conformance/bus_conformance.hpp"

namespace limbcast::conformance {

class DdsConformance : public BusConformance {};

/// Handlers that hang. Not for Cyclone DDS inside one process: it delivers to its own readers on
/// the writing thread, like inproc.
class SlowReaderConformance : public BusConformance {};

TEST_P(SlowReaderConformance, ReaderThatHangsDoesNotHoldTheWriterBack) {
  constexpr std::uint32_t kSamples = 2000;
  const auto check = [&]<typename T>(bus::TypeTag<T>) {
    const std::string topic(bus::Topic<T>::kShortName);
    Collector<T> collector;
    const auto peer = OpenPeer();
    const auto bus = OpenBus();
    const auto reader = Read(*bus, collector);
    Connect(*peer, collector);
    collector.Shut();
    const auto took = Write(*peer, topic, 1, 1, 1, kSamples);  // every single one must succeed
    EXPECT_LT(took, std::chrono::seconds(5)) << topic;         // one blocked write costs 100 ms
    collector.Open();
    EXPECT_TRUE(collector.WaitForSample(1, kSamples)) << topic << ": the newest is never lost";
    EXPECT_TRUE(collector.AllIntact()) << topic;
  };
  check(bus::TypeTag<MargSample>{});
  check(bus::TypeTag<MargFrame>{});
}

TEST_P(SlowReaderConformance, ReturnThatMeetsTheReportOfTheSilenceIsNoticed) {
  constexpr std::chrono::milliseconds kLease{300};
  Collector<MargSample> collector;
  const auto peer = OpenPeer({.lease = kLease});
  const auto bus = OpenBus("", kLease);
  const auto reader = Read(*bus, collector);
  Ok(*peer, "start marg 1 1 1 5000");
  ASSERT_TRUE(collector.WaitForCount(5));
  ASSERT_TRUE(events_.WaitFor(bus::BusEventKind::kLivelinessGained, "marg"));

  const std::size_t before = events_.size();
  events_.Hold(bus::BusEventKind::kLivelinessLost);
  Ok(*peer, "stop marg");
  EXPECT_TRUE(events_.WaitFor(bus::BusEventKind::kLivelinessLost, "marg", before));
  Ok(*peer, "write marg 1 1 5000 20 5000");  // meanwhile the library's thread is inside our handler
  events_.Release();
  Ok(*peer, "start marg 1 1 6000 5000");
  EXPECT_TRUE(events_.WaitFor(bus::BusEventKind::kLivelinessGained, "marg", before));
  EXPECT_TRUE(collector.WaitUntil(
      [](const auto& received, const auto&) { return received.back().sequence > 6000; }));
}

TEST_P(DdsConformance, SilentWriterIsNoticedAndItsReturnToo) {
  constexpr std::chrono::milliseconds kLease{300};
  Collector<MargSample> collector;
  const auto peer = OpenPeer({.lease = kLease});
  const auto bus = OpenBus("", kLease);
  const auto reader = Read(*bus, collector);
  Ok(*peer, "start marg 1 1 1 5000");
  ASSERT_TRUE(collector.WaitForCount(5));
  ASSERT_TRUE(events_.WaitFor(bus::BusEventKind::kLivelinessGained, "marg"));
  EXPECT_EQ(reader->counters().alive_writers, 1);

  const std::size_t before = events_.size();
  Ok(*peer, "stop marg");  // the process lives on, only its publishing thread does not
  ASSERT_TRUE(events_.WaitFor(bus::BusEventKind::kLivelinessLost, "marg", before));
  EXPECT_EQ(reader->counters().alive_writers, 0);
  EXPECT_GE(reader->counters().liveliness_lost, 1U);

  Ok(*peer, "start marg 1 1 5000 5000");
  EXPECT_TRUE(events_.WaitFor(bus::BusEventKind::kLivelinessGained, "marg", before));
  EXPECT_TRUE(collector.WaitUntil(
      [](const auto& received, const auto&) { return received.back().sequence > 5000; }));
}

TEST_P(DdsConformance, WriterThatLeavesInGoodOrderIsNoLivelinessLoss) {
  Collector<MargSample> collector;
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  const auto reader = Read(*bus, collector);
  Connect(*peer, collector);
  ASSERT_TRUE(events_.WaitFor(bus::BusEventKind::kMatched, "marg"));
  Ok(*peer, "drop marg");
  ASSERT_TRUE(events_.WaitFor(bus::BusEventKind::kUnmatched, "marg"));
  EXPECT_EQ(reader->counters().matched, 0);
  EXPECT_EQ(reader->counters().liveliness_lost, 0U);
}

TEST_P(DdsConformance, OwnerThatFallsSilentLosesItsInstances) {
  constexpr std::uint32_t kStrongFrom = 1'000'000;
  const auto from_strong = [](const Received& sample) { return sample.sequence >= kStrongFrom; };
  constexpr std::chrono::milliseconds kLease{300};
  Collector<SegmentState> collector;
  const auto bus = OpenBus("", kLease);
  const auto reader = Read(*bus, collector);
  const auto weak = OpenPeer({.strength = 5, .lease = kLease});
  const auto strong = OpenPeer({.strength = 20, .lease = kLease});
  Ok(*strong, "start segment_state 1 1 " + std::to_string(kStrongFrom) + " 5000");
  Ok(*weak, "start segment_state 1 1 1 5000");
  ASSERT_TRUE(collector.WaitUntil([&](const auto& received, const auto&) {
    return std::count_if(received.begin(), received.end(), from_strong) >= 20;
  }));
  Ok(*strong, "stop segment_state");
  const auto silent_at = std::chrono::steady_clock::now();
  ASSERT_TRUE(collector.WaitUntil([&](const auto& received, const auto&) {
    return !from_strong(received.back()) && received.back().at > silent_at;
  }));
  EXPECT_LT(std::chrono::steady_clock::now() - silent_at, kLease + std::chrono::seconds(2));
}

TEST_P(DdsConformance, MalformedPayloadIsCountedAndNothingElseSuffers) {
  const auto peer = OpenPeer();
  const auto bus = OpenBus();
  const auto check = [&]<typename T>(bus::TypeTag<T>) {
    const std::string topic(bus::Topic<T>::kShortName);
    Collector<T> collector;
    const auto reader = Read(*bus, collector);
    Connect(*peer, collector);
    const auto deadline = std::chrono::steady_clock::now() + kDeadline;
    do {  // until the bad writer is matched; not faster than its history keeps
      Ok(*peer, "garbage " + topic);
    } while (
        !events_.WaitFor(bus::BusEventKind::kMalformed, topic, 0, std::chrono::milliseconds(200)) &&
        std::chrono::steady_clock::now() < deadline);
    const std::uint64_t before = reader->counters().malformed;
    ASSERT_GT(before, 0U) << topic;
    const std::uint64_t sent = std::stoul(Ok(*peer, "garbage " + topic));
    Write(*peer, topic, 4, 2, 1, 10);
    EXPECT_TRUE(collector.WaitForCount(20)) << topic;
    EXPECT_EQ(collector.SequencesOf(4), Counting(1, 10)) << topic;
    EXPECT_TRUE(collector.AllIntact()) << topic;
    while (reader->counters().malformed < before + sent &&
           std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();  // no event says that the last one was counted
    }
    EXPECT_GE(reader->counters().malformed, before + sent) << topic << ": one kind is not counted";
    EXPECT_EQ(collector.received().size(), 20U) << topic << ": handed on what is garbage";

    Ok(*peer, "encapsulations " + topic);
    Write(*peer, topic, 6, 1, 1, 10);
    EXPECT_TRUE(collector.WaitForSample(6, 10)) << topic;
    EXPECT_EQ(collector.received().size(), 30U) << topic << ": handed on what is garbage";
  };
  check(bus::TypeTag<MargSample>{});
  check(bus::TypeTag<MargFrame>{});
  check(bus::TypeTag<SegmentState>{});
  check(bus::TypeTag<SegmentFrame>{});
}

TEST_P(DdsConformance, IncompatibleQosIsNamedOnBothSides) {
  Collector<MargSample> collector;
  const auto peer = OpenPeer({.lease = std::chrono::seconds(9)});  // slower than we ask for
  const auto bus = OpenBus("", std::chrono::milliseconds(500));
  const auto reader = Read(*bus, collector);
  Ok(*peer, "start marg 1 1 1 5000");
  ASSERT_TRUE(events_.WaitForDetail(bus::BusEventKind::kIncompatibleQos, "marg", "liveliness"));
  EXPECT_GE(reader->counters().incompatible_qos, 1U);

  const auto deadline = std::chrono::steady_clock::now() + kDeadline;
  std::string of_peer;
  do {
    of_peer = Ok(*peer, "events");
  } while (of_peer.find("incompatible_qos/marg/liveliness") == std::string::npos &&
           std::chrono::steady_clock::now() < deadline);
  EXPECT_NE(of_peer.find("incompatible_qos/marg/liveliness"), std::string::npos) << of_peer;
  EXPECT_TRUE(collector.received().empty());
}

TEST_P(DdsConformance, EqualLeasesMatchWhateverTheyAre) {
  for (const int lease_ms : {60, 333, 1001, 59'999}) {
    const std::chrono::milliseconds lease(lease_ms);
    Collector<MargSample> collector;
    const auto bus = OpenBus("", lease);
    const auto reader = Read(*bus, collector);
    const auto peer = OpenPeer({.lease = lease});
    Connect(*peer, collector);
    EXPECT_EQ(reader->counters().incompatible_qos, 0U) << lease_ms << " ms";
  }
}

TEST_P(DdsConformance, RestartedWriterIsPickedUp) {
  Collector<MargSample> stream;
  Collector<RosterEntry> state;
  const auto bus = OpenBus();
  const auto stream_reader = Read(*bus, stream);
  const auto state_reader = Read(*bus, state);
  for (std::uint32_t start = 1; start <= 3; ++start) {
    const auto peer = OpenPeer();
    Connect(*peer, stream);
    Write(*peer, "marg", 1, 1, start * 10, 5);
    Write(*peer, "roster", 1, 1, start, 1);
    EXPECT_TRUE(stream.WaitForSample(1, start * 10 + 4));
    EXPECT_TRUE(state.WaitForSample(1, start));
  }
  EXPECT_TRUE(state.disposed().empty()) << "leaving is not disposing";
}

TEST_P(DdsConformance, SuccessorOfAWriterThatLeftDisposesOfItsInstancesAndWritesThem) {
  const auto bus = OpenBus();
  const auto check = [&]<typename T>(bus::TypeTag<T>) {
    const std::string topic(bus::Topic<T>::kShortName);
    Collector<T> collector;
    const auto reader = Read(*bus, collector);
    const auto peer = OpenPeer();
    Connect(*peer, collector);
    Write(*peer, topic, 1, 1, 1, 1);
    ASSERT_TRUE(collector.WaitForSample(1, 1)) << topic;
    const std::size_t before = events_.size();
    Ok(*peer, "drop " + topic);
    ASSERT_TRUE(events_.WaitFor(bus::BusEventKind::kUnmatched, topic, before)) << topic;

    Connect(*peer, collector);
    for (std::uint32_t round = 1; round <= 3; ++round) {
      Ok(*peer, "dispose " + topic + " 1");
      EXPECT_TRUE(collector.WaitUntil([&](const auto&, const auto& disposed) {
        return disposed.size() >= round;
      })) << topic;
      Write(*peer, topic, 1, 1, 1 + round, 1);
      EXPECT_TRUE(collector.WaitForSample(1, 1 + round)) << topic;
    }
    EXPECT_EQ(collector.disposed(), std::vector<std::uint32_t>(3, 1)) << topic;
  };
  check(bus::TypeTag<RosterEntry>{});
  check(bus::TypeTag<MargSample>{});
  check(bus::TypeTag<SegmentState>{});
}

/// A writer on Cyclone DDS, which can lose packets on purpose, in a process of its own.
class LossyConformance : public BusConformance {};

TEST_P(LossyConformance, EverySampleArrivesOnceAndInOrderThoughOnePacketInTenIsLost) {
  constexpr std::uint32_t kSensors = 3;
  constexpr std::uint32_t kRounds = 300;
  constexpr std::int32_t kDepth = 1024;  // nothing is overwritten before it is asked for again
  Collector<MargSample> collector;
  const auto peer = OpenPeer({.depth = kDepth, .loss_permille = 100});
  const auto bus = OpenBus("", std::chrono::milliseconds(2000), kDepth);
  const auto reader = Read(*bus, collector);
  Connect(*peer, collector);
  Write(*peer, "marg", 1, kSensors, 1, kRounds, std::chrono::milliseconds(2));
  ASSERT_TRUE(collector.WaitForCount(kSensors * kRounds));
  for (std::uint32_t key = 1; key <= kSensors; ++key) {
    EXPECT_EQ(collector.SequencesOf(key), Counting(1, kRounds)) << "sensor " << key;
  }
  EXPECT_EQ(reader->counters().lost, 0U);
  EXPECT_TRUE(collector.AllIntact());
}

/// Cases that need a process to kill; every pair has two processes.
class ProcessConformance : public BusConformance {
 protected:
  [[nodiscard]] std::unique_ptr<ProcessPeer> OpenProcess(const PeerOptions& options) {
    auto peer = std::make_unique<ProcessPeer>(LIMBCAST_BUS_PEER);
    OpenIn(*peer, options);
    return peer;
  }
};

TEST_P(ProcessConformance, KilledWriterIsNoticedWithinItsLeaseAndItsSuccessorIsHeard) {
  constexpr std::chrono::milliseconds kLease{300};
  Collector<MargSample> collector;
  const auto bus = OpenBus("", kLease);
  const auto reader = Read(*bus, collector);
  const auto peer = OpenProcess({.lease = kLease});
  Ok(*peer, "start marg 1 1 1 5000");
  ASSERT_TRUE(collector.WaitForCount(20));

  const std::size_t before = events_.size();
  const std::uint64_t lost_before = reader->counters().liveliness_lost;
  const auto killed_at = std::chrono::steady_clock::now();
  peer->Kill();
  ASSERT_TRUE(events_.WaitFor(bus::BusEventKind::kLivelinessLost, "marg", before));
  const auto noticed_after =
      events_.Get(bus::BusEventKind::kLivelinessLost, "marg", before).second - killed_at;
  EXPECT_LT(noticed_after, kLease + std::chrono::seconds(1));
  EXPECT_GT(reader->counters().liveliness_lost, lost_before);
  EXPECT_EQ(reader->counters().alive_writers, 0);

  const auto successor = OpenProcess({.lease = kLease});
  Ok(*successor, "start marg 1 1 700000 5000");
  EXPECT_TRUE(collector.WaitUntil(
      [](const auto& received, const auto&) { return received.back().sequence > 700'000; }));
}

TEST_P(ProcessConformance, WeakerWriterTakesOverWithinTheLeaseWhenTheOwnerIsKilled) {
  constexpr std::uint32_t kStrongFrom = 1'000'000;
  const auto from_strong = [](const Received& sample) { return sample.sequence >= kStrongFrom; };
  constexpr std::chrono::milliseconds kLease{500};
  Collector<SegmentState> collector;
  const auto bus = OpenBus("", kLease);
  const auto reader = Read(*bus, collector);
  const auto weak = OpenProcess({.strength = 5, .lease = kLease});
  const auto strong = OpenProcess({.strength = 20, .lease = kLease});
  Ok(*strong, "start segment_state 1 1 " + std::to_string(kStrongFrom) + " 5000");
  Ok(*weak, "start segment_state 1 1 1 5000");
  ASSERT_TRUE(collector.WaitUntil([&](const auto& received, const auto&) {
    return std::count_if(received.begin(), received.end(), from_strong) >= 20;
  }));
  const auto killed_at = std::chrono::steady_clock::now();
  strong->Kill();
  ASSERT_TRUE(collector.WaitUntil([&](const auto& received, const auto&) {
    return !from_strong(received.back()) && received.back().at > killed_at;
  }));
  EXPECT_LT(std::chrono::steady_clock::now() - killed_at, kLease + std::chrono::seconds(1));
}

}  // namespace limbcast::conformance
