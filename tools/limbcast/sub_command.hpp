#pragma once

#include <CLI/CLI.hpp>
#include <functional>

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

}  // namespace limbcast::tool
