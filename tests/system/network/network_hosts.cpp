#include "tests/system/network/network_hosts.hpp"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "common/base/expects.hpp"
#include "tests/system/program.hpp"

namespace limbcast::test_support {
namespace {

Status Ip(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "ip");
  const Outcome outcome = RunToEnd(arguments);
  if (outcome.status == 0 && outcome.started && !outcome.timed_out) {
    return Ok();
  }
  std::string what;
  for (const std::string& argument : arguments) {
    what += argument + ' ';
  }
  std::string why = outcome.errors;
  std::replace(why.begin(), why.end(), '\n', ' ');
  return Error{ErrorCode::kUnavailable, what + "failed: " + why};
}

}  // namespace

NetworkHosts::NetworkHosts(std::size_t count)
    : prefix_("limbcast" + std::to_string(getpid())), count_(count) {}

Result<std::unique_ptr<NetworkHosts>> NetworkHosts::Make(std::size_t count) {
  std::unique_ptr<NetworkHosts> hosts(new NetworkHosts(count));
  if (const Status built = hosts->Build(); !built) {
    return built.error();
  }
  return hosts;
}

NetworkHosts::~NetworkHosts() {
  for (std::size_t host = 0; host < count_; ++host) {
    (void)Ip({"netns", "delete", NameOf(host)});
  }
  (void)Ip({"netns", "delete", SwitchName()});
}

std::string NetworkHosts::NameOf(std::size_t host) const {
  return prefix_ + "-" + std::to_string(host + 1);
}
std::string NetworkHosts::SwitchName() const { return prefix_ + "-switch"; }
std::string NetworkHosts::AddressOf(std::size_t host) {
  return "10.77.0." + std::to_string(host + 1);
}

Status NetworkHosts::Build() {
  const std::string the_switch = SwitchName();
  Status done = Ip({"netns", "add", the_switch});
  const auto then = [&](const std::vector<std::string>& arguments) {
    done = done ? Ip(arguments) : done;
  };
  then({"-n", the_switch, "link", "add", "br0", "type", "bridge", "mcast_snooping", "0"});
  then({"-n", the_switch, "link", "set", "br0", "up"});
  for (std::size_t host = 0; host < count_; ++host) {
    const std::string name = NameOf(host);
    const std::string port = "port" + std::to_string(host + 1);
    then({"netns", "add", name});
    then({"-n", name, "link", "add", "eth0", "type", "veth", "peer", "name", port, "netns",
          the_switch});
    then({"-n", the_switch, "link", "set", port, "master", "br0", "up"});
    then({"-n", name, "addr", "add", AddressOf(host) + "/24", "dev", "eth0"});
    then({"-n", name, "link", "set", "lo", "up"});
    then({"-n", name, "link", "set", "eth0", "up"});
    then({"-n", name, "route", "add", "224.0.0.0/4", "dev", "eth0"});
  }
  return done;
}

std::vector<std::string> NetworkHosts::On(std::size_t host,
                                          std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), {"ip", "netns", "exec", NameOf(host)});
  return arguments;
}

void NetworkHosts::RunOn(std::size_t host, const std::function<void()>& task) const {
  std::thread([&] {
    const int there = open(("/run/netns/" + NameOf(host)).c_str(), O_RDONLY | O_CLOEXEC);
    Expects(there >= 0 && setns(there, CLONE_NEWNET) == 0, "a namespace that Build has made");
    close(there);
    task();
  }).join();
}

void NetworkHosts::Connect(std::size_t host, bool connected) const {
  const Status done = Ip({"-n", SwitchName(), "link", "set", "port" + std::to_string(host + 1),
                          connected ? "up" : "down"});
  Expects(done.ok(), "a port that Build has made");
}

}  // namespace limbcast::test_support
