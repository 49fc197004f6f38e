#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <string_view>

#include "common/base/result.hpp"
#include "common/service/service_command_line.hpp"

namespace limbcast::tool {

/// One word after `limbcast`. Each has a file pair of its own, <word>_command, with a function
///
///   SubCommand Add<Word>Command(service::ServiceCommandLine& line);
///
/// that adds it to line.app() (options of the line itself may follow the word), and a line in
/// main.cpp that calls it.
struct SubCommand {
  CLI::App* app = nullptr;
  std::function<int()> run;  ///< called when the word was given; returns the exit status
};

/// One line on stderr for what a person gave wrong; the exit status 2.
inline int Refuse(std::string_view command, const Error& error) {
  fmt::print(stderr, "{}: {}\n", command, error.message);
  return 2;
}

}  // namespace limbcast::tool
