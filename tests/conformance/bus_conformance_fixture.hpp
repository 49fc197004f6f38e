#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "common/bus/bus_factory.hpp"
#include "tests/conformance/collector.hpp"
#include "tests/conformance/peer.hpp"
#include "tests/unit/common/bus/test_domain.hpp"

namespace limbcast::conformance {

/// Who writes, who reads, and whether the writer is a process of its own.
struct Pair {
  std::string name;
  bus::Vendor writer = bus::Vendor::kInproc;
  bus::Vendor reader = bus::Vendor::kInproc;
  bool two_processes = false;
};
inline void PrintTo(const Pair& pair, std::ostream* out) { *out << pair.name; }

/// How a peer joins.
struct PeerOptions {
  std::string partition = {};  // "" = that of the test
  std::int32_t strength = 10;
  std::chrono::milliseconds lease{2000};
  std::int32_t depth = bus::BusConfig().stream_depth;
  std::int32_t loss_permille = 0;  // of the packets that it sends (Cyclone DDS)
};

/// One test on one pair: its own domain and partition, readers in this process, writers in peers.
class BusConformance : public ::testing::TestWithParam<Pair> {
 protected:
  BusConformance() {
    static std::atomic<unsigned> tests = 0;
    domain_ = bus::testing::TestDomain();  // CTest runs each test in a process of its own
    partition_ = "p" + std::to_string(getpid()) + "_" + std::to_string(tests++);
  }

  [[nodiscard]] static std::string NameOf(bus::Vendor vendor) {
    return vendor == bus::Vendor::kCyclone ? "cyclone"
           : vendor == bus::Vendor::kFast  ? "fast"
                                           : "inproc";
  }

  [[nodiscard]] std::unique_ptr<Peer> OpenPeer(const PeerOptions& options = {}) {
    std::unique_ptr<Peer> peer;
    if (GetParam().two_processes) {
      peer = std::make_unique<ProcessPeer>(LIMBCAST_BUS_PEER);
    } else {
      peer = std::make_unique<LocalPeer>();
    }
    OpenIn(*peer, options);
    return peer;
  }
  void OpenIn(Peer& peer, const PeerOptions& options = {}) {
    const std::string partition = options.partition.empty() ? partition_ : options.partition;
    Ok(peer, "open " + NameOf(GetParam().writer) + " " + std::to_string(domain_) + " " + partition +
                 " " + std::to_string(options.strength) + " " +
                 std::to_string(options.lease.count()) + " " + std::to_string(options.depth) + " " +
                 std::to_string(options.loss_permille));
  }

  [[nodiscard]] std::unique_ptr<bus::Bus> OpenBus(
      const std::string& partition = "",
      std::chrono::milliseconds lease = std::chrono::milliseconds(2000),
      std::int32_t depth = bus::BusConfig().stream_depth) {
    bus::BusConfig config;
    config.vendor = GetParam().reader;
    config.domain_id = domain_;
    config.partition = partition.empty() ? partition_ : partition;
    config.participant_name = "limbcast-conformance";
    config.stream_lease = lease;
    config.stream_depth = depth;
    auto opened = bus::Open(config, events_.Handler());
    if (!opened) {
      ADD_FAILURE() << opened.error().message;
      return nullptr;
    }
    return std::move(opened).value();
  }

  template <typename T>
  [[nodiscard]] static std::unique_ptr<bus::Reader<T>> Read(bus::Bus& bus,
                                                            Collector<T>& collector) {
    auto made = bus.MakeReader<T>(collector.Handler());
    if (!made) {
      ADD_FAILURE() << made.error().message;
      return nullptr;
    }
    return std::move(made).value();
  }

  /// The command must work; gives what follows "ok ".
  static std::string Ok(Peer& peer, const std::string& line) {
    const std::string reply = peer.Do(line);
    EXPECT_EQ(reply.substr(0, 2), "ok") << line << " -> " << reply;
    return reply.size() > 3 ? reply.substr(3) : "";
  }

  /// Writes `rounds` rounds of `keys` instances.
  static std::chrono::nanoseconds Write(Peer& peer, const std::string& topic,
                                        std::uint32_t first_key, std::uint32_t keys,
                                        std::uint32_t first_sequence, std::uint32_t rounds,
                                        std::chrono::microseconds period = {}) {
    const std::string took =
        Ok(peer, "write " + topic + " " + std::to_string(first_key) + " " + std::to_string(keys) +
                     " " + std::to_string(first_sequence) + " " + std::to_string(rounds) + " " +
                     std::to_string(period.count()));
    return std::chrono::nanoseconds(took.empty() ? 0 : std::stoll(took));
  }

  /// Returns when data flows from the peer to the reader: matching is not symmetric, and across
  /// vendors it may take seconds, so only data proves it. Leaves only warm-up samples.
  template <typename T>
  static void Connect(Peer& peer, Collector<T>& collector) {
    const std::string topic(bus::Topic<T>::kShortName);
    const std::size_t before = collector.warm_ups();
    Ok(peer, "start " + topic + " " + std::to_string(kWarmUpKey) + " 1 1 2000");
    EXPECT_TRUE(collector.WaitForWarmUp(before)) << "no data on " << topic;
    Ok(peer, "stop " + topic);
  }

  unsigned domain_ = 0;
  std::string partition_;
  EventLog events_;
};

}  // namespace limbcast::conformance
