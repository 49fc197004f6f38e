#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace limbcast::test_support {

/// Hosts on one network switch: network namespaces of the kernel, each with an interface eth0 and
/// the address 10.77.0.N, N from 1. They go with the object. Needs root.
class NetworkHosts {
 public:
  /// Fails with kUnavailable when this process may not make any, or there is no `ip`.
  [[nodiscard]] static Result<std::unique_ptr<NetworkHosts>> Make(std::size_t count);
  ~NetworkHosts();
  NetworkHosts(const NetworkHosts&) = delete;
  NetworkHosts& operator=(const NetworkHosts&) = delete;

  /// `arguments` as a command line that runs on a host (from 0). It becomes the program itself, so
  /// signals reach it.
  [[nodiscard]] std::vector<std::string> On(std::size_t host,
                                            std::vector<std::string> arguments) const;
  /// Runs `task` in a thread that lives on a host, and waits for it. Sockets that it opens, and
  /// threads that it starts, stay there.
  void RunOn(std::size_t host, const std::function<void()>& task) const;

  /// Pulls the cable of a host out, or puts it in again.
  void Connect(std::size_t host, bool connected) const;
  [[nodiscard]] static std::string AddressOf(std::size_t host);

 private:
  explicit NetworkHosts(std::size_t count);
  [[nodiscard]] Status Build();
  [[nodiscard]] std::string NameOf(std::size_t host) const;
  [[nodiscard]] std::string SwitchName() const;

  const std::string prefix_;
  const std::size_t count_;
};

}  // namespace limbcast::test_support
