#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "common/bus/bus.hpp"
#include "tests/conformance/raw_writer.hpp"
#include "tests/conformance/topic_writer.hpp"

namespace limbcast::conformance {

/// The writing side of a conformance test: does what lines of text say, so that the same test runs
/// it within its own process or in another one (bus_peer). Every reply is one line, "ok ..." or
/// "error <why>". Thread-compatible.
///
///   open <vendor> <domain> <partition or -> <strength> <lease_ms> <depth> <loss_permille>
///   writer <topic>                    drop <topic>
///   write <topic> <first_key> <keys> <first_sequence> <rounds> <period_us>
///       writes each of the keys once in each round     -> ok <nanoseconds that took>
///   start <topic> <first_key> <keys> <first_sequence> <period_us>
///       the same without end, in the background
///   stop <topic>                      -> ok <next sequence>
///   dispose <topic> <key>
///   garbage <topic>                   sends every payload of Garbage() -> ok <how many>
///   encapsulations <topic>            sends every payload of BadEncapsulations() -> ok <how many>
///   counters <topic>                  -> ok matched=<n> incompatible_qos=<n>
///   events                            -> ok <kind>/<topic>/<detail> ...
///   close                             destroys everything that open made
class PeerSession {
 public:
  PeerSession() = default;
  ~PeerSession();
  PeerSession(const PeerSession&) = delete;
  PeerSession& operator=(const PeerSession&) = delete;

  [[nodiscard]] std::string Do(const std::string& line);

 private:
  using Words = std::vector<std::string>;

  struct Stream {
    explicit Stream(std::uint32_t first_sequence) : next_sequence(first_sequence) {}
    std::atomic<bool> stop = false;
    std::atomic<std::uint32_t> next_sequence;
    std::thread thread;
  };

  Result<std::string> Open(const Words& words);
  Result<std::string> Write(const Words& words);
  Result<std::string> Start(const Words& words);
  Result<std::string> Stop(const std::string& topic);
  Result<std::string> SendGarbage(const std::string& topic, const std::vector<Bytes>& garbage);
  Result<std::string> Counters(const std::string& topic);
  Result<std::string> Events();
  Result<std::string> Dispatch(const Words& words);
  void Close();
  Result<TopicWriter*> WriterOf(const std::string& topic);

  std::mutex events_mutex_;  // guards events_
  std::string events_;
  bus::BusConfig config_;
  std::unique_ptr<bus::Bus> bus_;
  std::map<std::string, std::unique_ptr<RawWriter>> raw_writers_;
  std::map<std::string, std::unique_ptr<TopicWriter>> writers_;
  std::map<std::string, std::unique_ptr<Stream>> streams_;  // by topic
};

}  // namespace limbcast::conformance
