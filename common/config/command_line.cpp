#include "common/config/command_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace limbcast::config {

namespace {

constexpr int kExitRefused = 1;
constexpr int kExitUsage = 2;

std::string OneLine(std::string text) {
  while (!text.empty() && text.back() == '\n') {
    text.pop_back();
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string_view Version() { return LIMBCAST_VERSION; }

CommandLine::CommandLine(std::string program, std::string description, std::string examples)
    : program_(std::move(program)), app_(std::move(description), program_) {
  app_.set_version_flag("--version", fmt::format("{} {}", program_, Version()),
                        "Print the version and exit");
  app_.set_help_flag("-h,--help", "Print this help and exit");
  app_.add_option("-c,--config", config_paths_,
                  "TOML file with the settings (deploy/config has one to start from); several are "
                  "put one over the other")
      ->type_name("FILE.toml")
      ->allow_extra_args(false);
  app_.add_option("--set", overrides_, "Put one setting over the file; may be given several times")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app_.footer("\nExamples:\n" + std::move(examples));
}

std::optional<int> CommandLine::Parse(int argc, const char* const* argv) {
  try {  // the parser throws; nothing else here does
    app_.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) {
      app_.exit(error);  // prints the help or the version
      return 0;
    }
    return Fail(Error{ErrorCode::kInvalidArgument,
                      fmt::format("{} (see {} --help)", OneLine(error.what()), program_)});
  }
}

Result<ConfigFile> CommandLine::LoadConfig() const {
  ConfigFile file;
  for (const std::string& path : config_paths_) {
    Result<ConfigFile> loaded = ConfigFile::Load(path);
    if (!loaded) {
      return loaded.error();
    }
    if (&path == &config_paths_.front()) {
      file = std::move(*loaded);
    } else {
      file.PutOver(std::move(*loaded));
    }
  }
  for (const std::string& assignment : overrides_) {
    if (const Status done = file.Override(assignment); !done) {
      return done.error();
    }
  }
  return file;
}

int CommandLine::Fail(const Error& error) const {
  fmt::print(stderr, "{}: {}\n", program_, OneLine(error.message));
  const bool refused = error.code == ErrorCode::kUnavailable || error.code == ErrorCode::kTimeout;
  return refused ? kExitRefused : kExitUsage;
}

}  // namespace limbcast::config
