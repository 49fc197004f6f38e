#include "common/bus/bus_config.hpp"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

namespace limbcast::bus {
namespace {

constexpr std::uint32_t kMaxDomainId = 101;
constexpr std::size_t kMaxName = 64;

Error OutOfRange(std::string_view key, std::string_view range, const std::string& value) {
  return Error{ErrorCode::kInvalidArgument,
               "bus." + std::string(key) + " must be " + std::string(range) + ", is " + value};
}

std::string Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) {
    return {};
  }
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

// Addresses and interface names go into the middleware's own configuration text.
bool IsPlainName(const std::string& text) {
  return !text.empty() && text.size() <= kMaxName &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '.' || c == ':' || c == '-' || c == '_' || c == '%' || c == '@';
         });
}

Status ValidateNames(const BusConfig& config) {
  if (config.partition.size() > kMaxName) {
    return OutOfRange("partition", "at most 64 characters",
                      std::to_string(config.partition.size()) + " long");
  }
  if (config.partition.find(',') != std::string::npos) {
    return OutOfRange("partition", "one name without commas", '"' + config.partition + '"');
  }
  if (config.participant_name.size() > kMaxName) {
    return OutOfRange("participant_name", "at most 64 characters",
                      std::to_string(config.participant_name.size()) + " long");
  }
  if (config.network == NetworkProfile::kInterfaces && config.interfaces.empty()) {
    return OutOfRange("network", "loopback, lan, wifi or names of interfaces", "\"\"");
  }
  for (const std::string& name : config.interfaces) {
    if (!IsPlainName(name)) {
      return OutOfRange("network", "names or addresses of interfaces", '"' + name + '"');
    }
  }
  if (!config.security_dir.empty() && !IsPlainName(config.security_role)) {
    return OutOfRange("security_role", "the name of a role", '"' + config.security_role + '"');
  }
  for (const std::string& peer : config.peers) {
    if (!IsPlainName(peer)) {
      return OutOfRange("peers", "names or addresses of hosts", '"' + peer + '"');
    }
  }
  return Ok();
}

}  // namespace

Status Validate(const BusConfig& config) {
  if (config.domain_id > kMaxDomainId) {
    return OutOfRange("domain_id", "in [0, 101]", std::to_string(config.domain_id));
  }
  if (config.ownership_strength < 0 || config.ownership_strength > 1000) {
    return OutOfRange("ownership_strength", "in [0, 1000]",
                      std::to_string(config.ownership_strength));
  }
  if (config.stream_lease < std::chrono::milliseconds(50) ||
      config.stream_lease > std::chrono::seconds(60)) {
    return OutOfRange("stream_lease_s", "in [0.05, 60]",
                      std::to_string(ToSeconds(config.stream_lease)));
  }
  if (config.stream_depth < 1 || config.stream_depth > 1024) {
    return OutOfRange("stream_depth", "in [1, 1024]", std::to_string(config.stream_depth));
  }
  if (config.send_loss_permille < 0 || config.send_loss_permille > 500) {
    return OutOfRange("send_loss_permille", "in [0, 500]",
                      std::to_string(config.send_loss_permille));
  }
  return ValidateNames(config);
}

Result<Vendor> ParseVendor(const std::string& text) {
  if (text == "cyclone") {
    return Vendor::kCyclone;
  }
  if (text == "fast") {
    return Vendor::kFast;
  }
  if (text == "inproc") {
    return Vendor::kInproc;
  }
  return Error{ErrorCode::kInvalidArgument,
               "bus.dds must be one of cyclone, fast, inproc, is \"" + text + '"'};
}

Status ParseNetwork(const std::string& text, BusConfig& config) {
  for (const auto& [name, profile] : {std::pair{"loopback", NetworkProfile::kLoopback},
                                      {"lan", NetworkProfile::kLan},
                                      {"wifi", NetworkProfile::kWifi}}) {
    if (text == name) {
      config.network = profile;
      config.interfaces.clear();
      return Ok();
    }
  }
  const bool is_wifi = text.starts_with("wifi:");
  std::vector<std::string> interfaces;
  std::size_t start = is_wifi ? 5 : (text.starts_with("lan:") ? 4 : 0);
  while (start <= text.size()) {
    const std::size_t comma = std::min(text.find(',', start), text.size());
    interfaces.push_back(Trimmed(std::string_view(text).substr(start, comma - start)));
    start = comma + 1;
  }
  for (const std::string& name : interfaces) {
    if (!IsPlainName(name)) {
      return OutOfRange("network", "loopback, lan, wifi or names of interfaces", '"' + text + '"');
    }
  }
  config.network = is_wifi ? NetworkProfile::kWifi : NetworkProfile::kInterfaces;
  config.interfaces = std::move(interfaces);
  return Ok();
}

}  // namespace limbcast::bus
