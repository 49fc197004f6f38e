#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <sstream>
#include <string>

#include "common/bus/bus.hpp"

namespace limbcast::security_test {

/// Every writer and reader that one bus may have, of all topics.
class AllEndpoints {
 public:
  virtual ~AllEndpoints() = default;
  /// "+w:marg -r:marg ...": which writers and readers there are, and which were refused.
  [[nodiscard]] virtual std::string Made() const = 0;
  /// Why one of "w:<topic>" or "r:<topic>" was refused.
  [[nodiscard]] virtual std::string Why(const std::string& endpoint) const = 0;
  /// Writes one Example on every topic.
  virtual void Write(std::uint32_t key, std::uint32_t sequence) = 0;
  /// "marg=<writer's peers>/<reader's peers>/<samples of others> ..."
  [[nodiscard]] virtual std::string Counts() const = 0;
  /// The keys that came, of all topics, ascending.
  [[nodiscard]] virtual std::string Keys() const = 0;
};
/// `own_key` is what this bus writes: samples with it are not counted as those of others.
[[nodiscard]] std::unique_ptr<AllEndpoints> MakeAllEndpoints(bus::Bus& bus, std::uint32_t own_key);

/// Buses that a test commands by lines of text, within another process (secure_peer): what runs in
/// one process does not meet over the network. Every reply is one line, "ok ..." or "error <why>".
///
///   open <name> <vendor> <domain> <folder or -> <role> <key>
///   endpoints <name>                  makes all that it may, see AllEndpoints::Made
///   why <name> <endpoint>   write <name> <sequence>   counts <name>   keys <name>   close <name>
class SecureSession {
 public:
  [[nodiscard]] std::string Do(const std::string& line);

 private:
  struct Open {
    std::unique_ptr<bus::Bus> bus;
    std::unique_ptr<AllEndpoints> endpoints;
    std::uint32_t key = 0;
  };
  Result<std::string> Dispatch(std::istringstream& words);
  Result<std::string> OpenBus(const std::string& name, std::istringstream& words);

  std::map<std::string, Open> buses_;
};

}  // namespace limbcast::security_test
