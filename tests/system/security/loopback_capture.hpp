#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/base/result.hpp"

namespace limbcast::security_test {

/// Every UDP packet of one DDS domain that passes the loopback interface, as a network sniffer sees
/// it.
class LoopbackCapture {
 public:
  /// Fails with kUnavailable when this process may not sniff (CAP_NET_RAW).
  [[nodiscard]] static Result<std::unique_ptr<LoopbackCapture>> Start(std::uint32_t domain);
  ~LoopbackCapture();
  LoopbackCapture(const LoopbackCapture&) = delete;
  LoopbackCapture& operator=(const LoopbackCapture&) = delete;

  /// Ends it; what was captured, packet by packet.
  [[nodiscard]] const std::vector<std::string>& Stop();

 private:
  LoopbackCapture(int socket, std::uint32_t first_port);
  void Run();

  const int socket_;
  const std::uint32_t first_port_;
  std::atomic<bool> stop_{false};
  std::vector<std::string> packets_;  // of the thread until it is joined
  std::thread thread_;
};

}  // namespace limbcast::security_test
