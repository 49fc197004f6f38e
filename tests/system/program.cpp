#include "tests/system/program.hpp"

#include <signal.h>
#include <stdlib.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>

#include "tools/limbcast/demo/free_domain.hpp"

namespace limbcast::test_support {
namespace {

std::vector<std::string> CommandLineOf(const std::filesystem::path& process) {
  std::ifstream file(process / "cmdline");
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) {
    arguments.push_back(argument);
  }
  return arguments;
}

bool IsOnDomain(const std::vector<std::string>& arguments, std::uint32_t domain) {
  const auto option = std::find(arguments.begin(), arguments.end(), "--domain");
  return option != arguments.end() && std::next(option) != arguments.end() &&
         *std::next(option) == std::to_string(domain);
}

// Programs in a network of their own (tests/system/network) may use the same domain.
template <typename Use>
void ForEachProcess(Use&& use) {
  std::error_code ignored;
  const auto network = std::filesystem::read_symlink("/proc/self/ns/net", ignored);
  for (const auto& entry : std::filesystem::directory_iterator("/proc", ignored)) {
    const std::string name = entry.path().filename();
    pid_t pid = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), pid).ec == std::errc{} &&
        std::filesystem::read_symlink(entry.path() / "ns" / "net", ignored) == network) {
      use(pid, CommandLineOf(entry.path()));
    }
  }
}

}  // namespace

std::string Program(const std::string& name) { return LIMBCAST_BIN_DIR "/" + name; }

std::string Describe(const Outcome& outcome) {
  std::ostringstream text;
  text << (outcome.started ? "" : "not started; ") << (outcome.timed_out ? "timed out; " : "")
       << "status " << outcome.status << ", signal " << outcome.signal << "\nstdout:\n"
       << outcome.output << "\nstderr:\n"
       << outcome.errors;
  return text.str();
}

Outcome RunToEnd(const std::vector<std::string>& arguments, Duration deadline) {
  Outcome outcome;
  auto child = process::ChildProcess::Start({.arguments = arguments});
  if (!child) {
    outcome.errors = child.error().message;
    return outcome;
  }
  outcome.started = true;
  auto ended = child->Wait(deadline);
  if (!ended) {
    outcome.timed_out = true;
    ended = child->Stop(std::chrono::seconds(5));
  }
  outcome.status = ended->status;
  outcome.signal = ended->signal;
  outcome.output = child->Output();
  outcome.errors = child->Errors();
  return outcome;
}

std::uint32_t OwnDomain() {
  // Tests that run at the same time are other processes: their pids keep them apart.
  static std::uint32_t calls = 0;
  std::ifstream file("/proc/net/udp");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const auto seed = static_cast<std::uint32_t>(getpid()) * 7U + 31U * calls++;
  return tool::FindFreeDomain(tool::ParseUdpPorts(text), seed).value();
}

std::vector<pid_t> ProcessesOnDomain(std::uint32_t domain) {
  std::vector<pid_t> found;
  ForEachProcess([&](pid_t pid, const std::vector<std::string>& arguments) {
    if (IsOnDomain(arguments, domain)) {
      found.push_back(pid);
    }
  });
  return found;
}

pid_t ProcessOnDomain(std::uint32_t domain, const std::string& name) {
  pid_t found = 0;
  ForEachProcess([&](pid_t pid, const std::vector<std::string>& arguments) {
    if (IsOnDomain(arguments, domain) && arguments[0] == Program(name)) {
      found = pid;
    }
  });
  return found;
}

std::set<std::string> SharedMemoryFiles() {
  std::set<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/shm", ignored)) {
    names.insert(entry.path().filename());
  }
  return names;
}

DemoRun RunDemo(std::vector<std::string> arguments, Duration deadline) {
  const TemporaryFolder folder;
  const std::string json_path = folder / "summary.json";
  const std::uint32_t domain = OwnDomain();
  arguments.insert(arguments.begin(), {Program("limbcast"), "demo"});
  arguments.insert(arguments.end(), {"--json", json_path, "--domain", std::to_string(domain)});
  const std::set<std::string> before = SharedMemoryFiles();
  DemoRun run;
  run.outcome = RunToEnd(arguments, deadline);
  run.processes_left = ProcessesOnDomain(domain).size();
  const std::set<std::string> after = SharedMemoryFiles();
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                      std::inserter(run.shared_memory_left, run.shared_memory_left.end()));
  std::ifstream file(json_path);
  run.summary = nlohmann::json::parse(file, nullptr, false);
  if (run.summary.is_discarded()) {
    run.summary = nullptr;
  }
  return run;
}

Balance BalanceOf(const nlohmann::json& summary) {
  Balance balance;
  balance.published = summary.at("samples_published").get<std::uint64_t>();
  balance.filtered = summary.at("samples_filtered").get<std::uint64_t>();
  balance.lost = summary.at("samples_lost").get<std::uint64_t>();
  for (const auto& [verdict, count] : summary.at("samples_refused").items()) {
    balance.refused += count.get<std::uint64_t>();
  }
  return balance;
}

}  // namespace limbcast::test_support
