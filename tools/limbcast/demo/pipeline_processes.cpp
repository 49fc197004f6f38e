#include "tools/limbcast/demo/pipeline_processes.hpp"

#include <fmt/format.h>
#include <signal.h>

#include <chrono>
#include <sstream>
#include <utility>

namespace limbcast::tool {
namespace {

using namespace std::chrono_literals;

constexpr int kMaxRestarts = 20;  // of one process; more is a failure, not somebody's test

// Someone's kill, as opposed to a crash.
bool KilledFromOutside(const process::ExitState& state) {
  return state.signal == SIGKILL || state.signal == SIGTERM || state.signal == SIGINT ||
         state.signal == SIGHUP || state.clean();
}

std::string LastLine(const std::string& text) {
  const auto end = text.find_last_not_of('\n');
  if (end == std::string::npos) {
    return "";
  }
  const auto before = text.rfind('\n', end);
  return text.substr(before == std::string::npos ? 0 : before + 1, end - (before + 1) + 1);
}

}  // namespace

std::vector<std::string> ArgumentsOf(Part part, const DemoOptions& options) {
  std::vector<std::string> arguments = {fmt::format("{}/limbcast-{}", options.folder, NameOf(part)),
                                        "--dds",
                                        std::string(VendorOf(options.dds, NameOf(part))),
                                        "--domain",
                                        std::to_string(options.bus.domain_id),
                                        "--log-level",
                                        "warning"};
  const auto add = [&](std::initializer_list<std::string> more) {
    arguments.insert(arguments.end(), more);
  };
  if (!options.bus.partition.empty()) {
    add({"--partition", options.bus.partition});
  }
  if (!options.bus.security_dir.empty()) {
    add({"--security", options.bus.security_dir});
  }
  // One message for a body and tick instead of one for each sensor, and what else makes many small
  // samples cheap (numbers: tests/benchmark/system).
  if (VendorOf(options.dds, NameOf(part)) == "cyclone") {
    add({"--set", "bus.write_batching=true"});
  }
  if (part == Part::kGateway) {
    add({"--set", "gateway.marg_frame=true"});
  } else if (part == Part::kFusion) {
    add({"--set", "fusion.segment_frame=true"});
  }
  // Before what the caller says, which then counts.
  if (options.coils && part == Part::kGateway) {
    add({"--set", "simulator.coils.source=pelvis", "--set", "simulator.iron=false"});
  } else if (options.coils && part == Part::kFusion) {
    add({"--set", "fusion.coils.source=pelvis"});
  }
  if ((options.coils || options.markers) && part == Part::kFusion) {
    add({"--set", "fusion.position_lag_s=0.5"});
  }
  if (options.markers && part == Part::kGateway) {
    add({"--set", "simulator.cameras.markers=[\"pelvis\"]"});
  } else if (options.markers && part == Part::kFusion) {
    add({"--set", "fusion.markers.segments=[\"pelvis\"]"});
  }
  for (const std::string& setting : options.service_settings) {
    add({"--set", setting});
  }
  if (part == Part::kGateway) {
    add({"--wait-for", "posture"});
    if (!options.recording.empty()) {
      add({"--recording", options.recording, "--exit-at-end", "--speed",
           options.speed.empty() ? "max" : options.speed});
    }
    for (const std::string& setting : options.gateway_settings) {
      add({"--set", setting});
    }
  }
  if (part == Part::kFusion) {
    for (const std::string& setting : options.fusion_settings) {
      add({"--set", setting});
    }
  }
  return arguments;
}

Status PipelineProcesses::Start(Part part) {
  auto started = process::ChildProcess::Start({.arguments = ArgumentsOf(part, options_)});
  if (!started) {
    return started.error();
  }
  sessions_.push_back(started->pid());
  children_[static_cast<std::size_t>(part)].process = std::move(*started);
  return Ok();
}

void PipelineProcesses::Collect(Part part, const process::ExitState& state) {
  auto& child = children_[static_cast<std::size_t>(part)].process;
  cpu_seconds_[std::string(NameOf(part))] += state.cpu_seconds;
  if (!state.clean()) {
    errors_ += fmt::format("{}: ended with status {}, signal {}\n", NameOf(part), state.status,
                           state.signal);
  }
  std::istringstream lines(child->Errors());
  for (std::string line; std::getline(lines, line);) {
    errors_ += fmt::format("{}: {}\n", NameOf(part), line);
  }
}

Status PipelineProcesses::Ended(Part part, const process::ExitState& state) {
  auto& child = children_[static_cast<std::size_t>(part)].process;
  Collect(part, state);
  const std::string last_words = LastLine(child->Errors());
  child.reset();
  const std::string name(NameOf(part));
  if (part == Part::kGateway && state.clean() && !options_.recording.empty()) {
    gateway_finished_ = true;
    return Ok();
  }
  if (state.signal == 0 && state.status != 0) {
    clean_ = false;
    return Error{state.status == 2 ? ErrorCode::kInvalidArgument : ErrorCode::kUnavailable,
                 last_words.empty()
                     ? fmt::format("limbcast-{} ended with status {}", name, state.status)
                     : last_words};
  }
  clean_ = clean_ && KilledFromOutside(state);
  if (++restarts_[name] > kMaxRestarts) {
    clean_ = false;
    return Error{ErrorCode::kUnavailable, fmt::format("limbcast-{} ended {} times, at most {}",
                                                      name, restarts_[name], kMaxRestarts)};
  }
  return Start(part);
}

Status PipelineProcesses::Supervise() {
  for (std::size_t i = 0; i < children_.size(); ++i) {
    auto& child = children_[i].process;
    if (!child) {
      continue;
    }
    if (const auto state = child->Poll()) {
      if (Status handled = Ended(static_cast<Part>(i), *state); !handled) {
        return handled;
      }
    }
  }
  return Ok();
}

bool PipelineProcesses::Stop(Part part) {
  auto& child = children_[static_cast<std::size_t>(part)].process;
  if (!child) {
    return true;
  }
  const process::ExitState state = child->Stop(10s);
  Collect(part, state);
  child.reset();
  clean_ = clean_ && state.clean();
  return state.clean();
}

std::uint32_t PipelineProcesses::pid(Part part) const {
  const auto& child = children_[static_cast<std::size_t>(part)].process;
  return child ? static_cast<std::uint32_t>(child->pid()) : 0;
}

std::size_t PipelineProcesses::leftovers() const {
  std::size_t count = 0;
  for (const pid_t session : sessions_) {
    count += process::SessionMembers(session).size();
  }
  return count;
}

std::string PipelineProcesses::Errors() const {
  std::string all = errors_;
  for (std::size_t i = 0; i < children_.size(); ++i) {
    if (children_[i].process) {
      std::istringstream lines(children_[i].process->Errors());
      for (std::string line; std::getline(lines, line);) {
        all += fmt::format("{}: {}\n", kPartNames[i], line);
      }
    }
  }
  return all;
}

}  // namespace limbcast::tool
