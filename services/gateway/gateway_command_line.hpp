#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/config/config_file.hpp"
#include "common/service/service_command_line.hpp"
#include "services/gateway/gateway_summary.hpp"

namespace limbcast::gateway {

/// The gateway's command line: shorthands for what its file says, put over it.
class GatewayCommandLine : public service::ServiceCommandLine {
 public:
  GatewayCommandLine();

  /// The file with --set and then the shorthands put over it.
  [[nodiscard]] Result<config::ConfigFile> LoadSettings() const;

  /// Prints the summary on stdout as --summary says.
  void PrintSummary(const GatewaySummary& summary) const;

 private:
  std::optional<std::string> driver_;
  std::optional<std::string> recording_;
  std::optional<std::string> speed_;
  std::optional<std::string> wait_for_;
  std::optional<std::string> person_;
  std::optional<std::uint32_t> body_id_;
  std::vector<std::string> assignments_;
  bool loop_ = false;
  bool exit_at_end_ = false;
  std::string summary_ = "none";
};

/// `text` as a TOML string in quotes.
[[nodiscard]] std::string TomlString(const std::string& text);

}  // namespace limbcast::gateway
