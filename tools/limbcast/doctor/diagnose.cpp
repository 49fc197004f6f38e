#include "tools/limbcast/doctor/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace limbcast::tool {
namespace {

using bus::BusEventKind;
using bus::NetworkInterface;
using bus::NetworkProfile;
using Findings = std::vector<Finding>;

constexpr std::size_t kCalledOnThisHost = 40;  // of Cyclone DDS on loopback, see common/bus
constexpr std::size_t kCalledByFast = 64;
constexpr std::int64_t kWantedBuffer_bytes = 4LL * 1024 * 1024;
// The delay of network and scheduler is in the first of them.
constexpr Duration kBehind = std::chrono::milliseconds(50);
constexpr Duration kAhead = std::chrono::milliseconds(5);
constexpr std::size_t kReportsToCompare = 2;  // the first may have been kept for us
constexpr std::uint64_t kStepsBack = 3;
constexpr Duration kRenewWithin = std::chrono::hours(24 * 14);

std::string Named(const NetworkInterface& interface) {
  return interface.name + ' ' + interface.address;
}

template <typename Range, typename Text>
std::string Joined(const Range& range, Text text) {
  std::string joined;
  for (const auto& item : range) {
    joined += (joined.empty() ? "" : ", ") + text(item);
  }
  return joined;
}

std::string OthersOf(const std::vector<NetworkInterface>& host) {
  std::vector<NetworkInterface> usable;
  std::copy_if(host.begin(), host.end(), std::back_inserter(usable),
               [](const NetworkInterface& one) { return one.up && !one.loopback; });
  return usable.empty() ? "none but the loopback" : Joined(usable, Named);
}

void FindInterfaces(const DoctorFacts& facts, Findings& findings) {
  const auto add = [&](std::string text, std::string advice) {
    findings.push_back({"wrong_interface", std::move(text), std::move(advice)});
  };
  for (const std::string& wanted : facts.config.interfaces) {
    const auto found = std::find_if(
        facts.host.begin(), facts.host.end(),
        [&](const NetworkInterface& one) { return one.name == wanted || one.address == wanted; });
    if (found == facts.host.end()) {
      add(fmt::format("interface {} does not exist on this host or has no IPv4 address", wanted),
          fmt::format("name one of: {}", OthersOf(facts.host)));
    } else if (!found->up) {
      add(fmt::format("interface {} is down", Named(*found)),
          fmt::format("bring it up, or name one of: {}", OthersOf(facts.host)));
    }
  }
  const auto used = bus::UsedInterfaces(facts.config, facts.host);
  if (used.empty() && facts.config.interfaces.empty()) {
    add("no interface is up that leaves this host", "bring one up, or use --network loopback");
  }
  for (const PeerProbe& probe : facts.probes) {
    if (probe.address.empty()) {
      findings.push_back({"unknown_peer", fmt::format("no IPv4 address for peer {}", probe.peer),
                          "name its address, or put it into the DNS or /etc/hosts"});
    } else if (probe.leaves_by.empty()) {
      add(fmt::format("there is no way from this host to peer {} ({})", probe.peer, probe.address),
          "check cable, Wi-Fi, address and routes of this host");
    } else if (std::none_of(used.begin(), used.end(), [&](const NetworkInterface& one) {
                 return one.address == probe.leaves_by ||
                        (one.loopback && probe.leaves_by.starts_with("127."));
               })) {
      add(fmt::format(
              "the way to peer {} leaves by {}, which is not among the interfaces in use ({})",
              probe.peer, probe.leaves_by, used.empty() ? "none" : Joined(used, Named)),
          fmt::format("use --network {}", probe.leaves_by));
    }
  }
}

void FindParticipants(const DoctorFacts& facts, Findings& findings) {
  const std::size_t limit =
      facts.config.vendor == bus::Vendor::kFast ? kCalledByFast : kCalledOnThisHost;
  if (facts.participants_here >= limit) {
    findings.push_back(
        {"too_many_participants",
         fmt::format(
             "{} participants of domain {} on this host: others call only the first {} of them",
             facts.participants_here, facts.config.domain_id, limit),
         "put several people into one gateway process, several sessions into several domains "
         "(--domain), or services onto more hosts"});
  }
}

bool IsAlone(const DoctorFacts& facts) {
  return facts.refusal.empty() && facts.processes.empty() && facts.peers_matched == 0 &&
         facts.mismatches.empty();
}

// Somebody is there, but nothing of it reaches us.
bool FindBlockedPorts(const DoctorFacts& facts, Findings& findings) {
  const std::uint32_t first = 7400 + 250 * facts.config.domain_id;
  const std::string advice = fmt::format(
      "let UDP ports {} to {} through the firewalls of both hosts{}", first, first + 249,
      facts.config.security_dir.empty()
          ? "; if the network is secured, say --security DIR"
          : "; if credentials differ, make both from one `limbcast security create`");
  bool found = false;
  for (const PeerProbe& probe : facts.probes) {
    if (probe.blocked > 0) {
      findings.push_back(
          {"blocked_ports",
           fmt::format("a firewall refuses packets to peer {} ({} of {} ports)", probe.peer,
                       probe.blocked, probe.blocked + probe.refused + probe.silent),
           advice});
      found = true;
    } else if (IsAlone(facts) && probe.silent > 0 && probe.refused == 0) {
      findings.push_back({"blocked_ports",
                          fmt::format("peer {} answers on none of {} ports: its host is off, or a "
                                      "firewall drops the packets",
                                      probe.peer, probe.silent),
                          advice});
      found = true;
    }
  }
  const auto is_ours = [&](const Announcement& heard) {
    return std::any_of(facts.host.begin(), facts.host.end(),
                       [&](const NetworkInterface& one) { return one.address == heard.address; });
  };
  std::set<Announcement> others;
  for (const Announcement& heard : facts.announcements) {
    if (!is_ours(heard)) {
      others.insert(heard);
    }
  }
  if (IsAlone(facts) && !others.empty() && !found) {
    findings.push_back(
        {"blocked_ports",
         fmt::format(
             "{} announce{} participants of this domain, but nothing else of them arrives",
             Joined(others,
                    [](const Announcement& one) { return one.address + " (" + one.library + ")"; }),
             others.size() == 1 ? "s" : ""),
         advice});
    found = true;
  }
  return found;
}

void FindPeers(const DoctorFacts& facts, Findings& findings) {
  if (!IsAlone(facts) || FindBlockedPorts(facts, findings)) {
    return;
  }
  std::string advice = "start a service, and check that domain and network are the same everywhere";
  if (facts.config.network == NetworkProfile::kLoopback) {
    advice += "; loopback does not leave this host: --network lan or wifi does";
  } else if (facts.config.peers.empty()) {
    advice += "; where multicast does not pass (most Wi-Fi), name the other hosts with --peer";
  }
  findings.push_back({"no_peers",
                      fmt::format("nobody answered in domain {} within {:.1f} s ({})",
                                  facts.config.domain_id, facts.listened_s, facts.network),
                      std::move(advice)});
}

void FindMismatches(const DoctorFacts& facts, Findings& findings) {
  for (const Mismatch& mismatch : facts.mismatches) {
    if (mismatch.kind == BusEventKind::kTypeMismatch) {
      findings.push_back(
          {"type_mismatch",
           fmt::format("somebody uses another type on {}: {}", mismatch.topic, mismatch.detail),
           "install the same version of Limbcast on all hosts"});
    } else {
      findings.push_back(
          {"qos_mismatch",
           fmt::format("somebody's {} does not fit ours: {}", mismatch.topic, mismatch.detail),
           mismatch.detail.find("LIVELINESS") != std::string::npos
               ? "give every process the same bus.stream_lease_s"
               : "install the same version of Limbcast on all hosts"});
    }
  }
  for (const auto& [uid, process] : facts.processes) {
    if (process.last_error.starts_with("bus: incompatible_qos") ||
        process.last_error.starts_with("bus: type_mismatch")) {
      findings.push_back(
          {process.last_error.starts_with("bus: type") ? "type_mismatch" : "qos_mismatch",
           fmt::format("{} {} on {} says: {}", process.role, process.pid, process.host,
                       process.last_error),
           "give every process the same bus settings and the same version of Limbcast"});
    }
  }
}

void FindClocks(const DoctorFacts& facts, Findings& findings) {
  std::set<std::string> told;  // one line for each host
  for (const auto& [uid, process] : facts.processes) {
    const bool ahead = process.smallest_age < -kAhead;
    if (process.reports < kReportsToCompare || (!ahead && process.smallest_age < kBehind) ||
        !told.insert(process.host).second) {
      continue;
    }
    findings.push_back({"clock_offset",
                        fmt::format("the clock of {} is about {:.0f} ms {} ours", process.host,
                                    std::abs(ToSeconds(process.smallest_age)) * 1e3,
                                    ahead ? "ahead of" : "behind"),
                        "synchronise all hosts by PTP (linuxptp) or NTP (chrony)"});
  }
}

void FindSessionHosts(const DoctorFacts& facts, Findings& findings) {
  std::vector<const ProcessFacts*> hosts;
  for (const auto& [uid, process] : facts.processes) {
    if (process.role == "session") {
      hosts.push_back(&process);
    }
  }
  if (hosts.size() > 1) {
    findings.push_back({"two_session_hosts",
                        fmt::format("{} session hosts: {}", hosts.size(),
                                    Joined(hosts,
                                           [](const ProcessFacts* one) {
                                             return fmt::format("pid {} on {}", one->pid,
                                                                one->host);
                                           })),
                        "stop all but one: each gives out body ids of its own"});
  }
}

void FindSensors(const DoctorFacts& facts, Findings& findings) {
  for (const auto& [uid, sensor] : facts.sensors) {
    const std::string name =
        sensor.serial.empty() ? fmt::format("{:016x}", uid.value) : sensor.serial;
    if (sensor.wearers.size() > 1) {
      findings.push_back({"duplicate_sensor",
                          fmt::format("sensor {} is worn by {}", name,
                                      Joined(sensor.wearers, [](const auto& one) { return one; })),
                          "take it out of all assignments but one, or give the sensors different "
                          "serial numbers"});
    } else if (sensor.steps_back >= kStepsBack) {
      findings.push_back(
          {"duplicate_sensor",
           fmt::format("sensor {} comes from two sources: its numbers fell or came again {} times "
                       "in {} samples",
                       name, sensor.steps_back, sensor.samples),
           "stop one of the gateways, or give the sensors different serial numbers"});
    }
  }
}

void FindOnThisHost(const DoctorFacts& facts, Findings& findings) {
  if (!facts.stale_shared_memory.empty()) {
    findings.push_back(
        {"stale_shared_memory",
         fmt::format("{} files of ended processes in /dev/shm ({}, ...)",
                     facts.stale_shared_memory.size(), facts.stale_shared_memory.front()),
         "run `fastdds shm clean` (Limbcast itself uses no shared memory)"});
  }
  if (facts.receive_buffer_bytes > 0 && facts.receive_buffer_bytes < kWantedBuffer_bytes) {
    findings.push_back({"small_socket_buffers",
                        fmt::format("net.core.rmem_max is {} bytes, at least {} are wanted: bursts "
                                    "of many people get lost",
                                    facts.receive_buffer_bytes, kWantedBuffer_bytes),
                        "install deploy/sysctl/90-limbcast.conf"});
  }
  if (facts.credentials_left && *facts.credentials_left < kRenewWithin) {
    findings.push_back(
        {"credentials_expire",
         fmt::format("the credentials in {} expire in {:.1f} days", facts.config.security_dir,
                     ToSeconds(*facts.credentials_left) / 86400.0),
         "run `limbcast security renew` and copy them to the hosts"});
  }
}

}  // namespace

std::vector<Finding> Diagnose(const DoctorFacts& facts) {
  Findings findings;
  FindInterfaces(facts, findings);
  FindParticipants(facts, findings);
  if (!facts.refusal.empty() && findings.empty()) {
    findings.push_back({"network_refused", facts.refusal, "see the message"});
  }
  FindPeers(facts, findings);
  FindMismatches(facts, findings);
  FindClocks(facts, findings);
  FindSessionHosts(facts, findings);
  FindSensors(facts, findings);
  FindOnThisHost(facts, findings);
  return findings;
}

std::string ToText(const Finding& finding) {
  return finding.id + ": " + finding.text + " -> " + finding.advice;
}

nlohmann::json ToJson(const DoctorFacts& facts, const std::vector<Finding>& findings) {
  nlohmann::json list = nlohmann::json::array();
  for (const Finding& finding : findings) {
    list.push_back({{"id", finding.id}, {"text", finding.text}, {"advice", finding.advice}});
  }
  return {{"network", facts.network},
          {"listened_s", facts.listened_s},
          {"processes", facts.processes.size()},
          {"peers", facts.peers_matched},
          {"findings", std::move(list)}};
}

}  // namespace limbcast::tool
