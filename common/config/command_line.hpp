#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "common/config/config_file.hpp"

namespace limbcast::config {

/// Version of the project, e.g. "0.1.0".
[[nodiscard]] std::string_view Version();

/// The command line that all executables share: --help (with examples), --version, --config FILE
/// and --set KEY=VALUE. Own options are added to app(). A bad option gives one line on stderr and
/// exit status 2.
class CommandLine {
 public:
  /// `program` is what a person types ("limbcast-fusion"); `examples` is printed below the options,
  /// one example a line.
  CommandLine(std::string program, std::string description, std::string examples);

  [[nodiscard]] CLI::App& app() { return app_; }
  [[nodiscard]] const std::string& program() const { return program_; }

  /// Nothing: go on. Else the status to exit with: 0 after --help or --version, 2 after a bad
  /// option.
  [[nodiscard]] std::optional<int> Parse(int argc, const char* const* argv);

  /// The file of --config (or defaults only) with every --set put over it.
  [[nodiscard]] Result<ConfigFile> LoadConfig() const;

  /// Prints "program: message" on one line of stderr. Returns the exit status for main: 2 when the
  /// user gave something wrong (kInvalidArgument, kNotFound, kCorruptData, kUnsupported), 1 when
  /// the machine or network refused (kUnavailable, kTimeout).
  [[nodiscard]] int Fail(const Error& error) const;

 private:
  std::string program_;
  CLI::App app_;
  std::vector<std::string> config_paths_;
  std::vector<std::string> overrides_;
};

}  // namespace limbcast::config
