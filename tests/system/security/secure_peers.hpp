#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/system_now.hpp"
#include "common/security/create.hpp"
#include "tests/conformance/peer.hpp"
#include "tests/system/program.hpp"

namespace limbcast::security_test {

/// The role of tests that may publish and hear all there is.
inline constexpr const char* kEverything = "everything";

/// However long a busy machine may take; a test that passes never waits for it.
inline constexpr std::chrono::seconds kDeadline{60};

inline std::vector<security::RoleGrant> RolesAndEverything() {
  std::vector<security::RoleGrant> roles = security::DefaultRoles();
  roles.push_back({kEverything, security::TopicNames(), security::TopicNames()});
  return roles;
}

inline security::RoleGrant GrantOf(const std::string& role) {
  for (security::RoleGrant& grant : RolesAndEverything()) {
    if (grant.role == role) {
      return std::move(grant);
    }
  }
  return {};
}

inline bool Has(const std::vector<std::string>& topics, const std::string& topic) {
  return std::find(topics.begin(), topics.end(), topic) != topics.end();
}

/// Credentials for all roles; valid for an hour, or expired since an hour.
inline void MakeCredentials(const std::filesystem::path& folder, bool expired = false) {
  using std::chrono::hours;
  const Time now = bus::SystemNow();
  security::CreateOptions options;
  options.roles = RolesAndEverything();
  options.authority = {now - hours(48), now + hours(48)};
  options.identities = {now - hours(24), expired ? now - hours(1) : now + hours(1)};
  const Status made = security::Create(folder, options);
  ASSERT_TRUE(made.ok()) << made.error().message;
}

struct Count {
  int writer_peers = 0;
  int reader_peers = 0;
  std::uint64_t of_others = 0;
};
using Counts = std::map<std::string, Count>;

/// One bus in a process of its own or beside others of that process.
class SecureBus {
 public:
  SecureBus(std::shared_ptr<conformance::ProcessPeer> process, std::string name)
      : process_(std::move(process)), name_(std::move(name)) {}
  explicit SecureBus(const std::string& name)
      : SecureBus(std::make_shared<conformance::ProcessPeer>(LIMBCAST_SECURE_PEER), name) {}

  [[nodiscard]] std::string Open(const std::string& vendor, std::uint32_t domain,
                                 const std::string& folder, const std::string& role,
                                 std::uint32_t key) {
    return process_->Do("open " + name_ + ' ' + vendor + ' ' + std::to_string(domain) + ' ' +
                        folder + ' ' + role + ' ' + std::to_string(key));
  }
  /// "+w:marg", "-r:marg", ...
  [[nodiscard]] std::set<std::string> MakeEndpoints() {
    std::istringstream made(process_->Do("endpoints " + name_));
    std::set<std::string> all;
    for (std::string word; made >> word;) {
      all.insert(word);
    }
    return all;
  }
  [[nodiscard]] std::string Why(const std::string& endpoint) {
    return process_->Do("why " + name_ + ' ' + endpoint);
  }
  void Write() {
    EXPECT_EQ(process_->Do("write " + name_ + ' ' + std::to_string(++sequence_)), "ok ");
  }
  [[nodiscard]] std::string Keys() { return process_->Do("keys " + name_); }
  [[nodiscard]] Counts Now() {
    std::istringstream text(process_->Do("counts " + name_));
    Counts counts;
    std::string word;
    text >> word;  // ok
    for (; text >> word;) {
      Count& count = counts[word.substr(0, word.find('='))];
      char slash = 0;
      std::istringstream(word.substr(word.find('=') + 1)) >> count.writer_peers >> slash >>
          count.reader_peers >> slash >> count.of_others;
    }
    return counts;
  }
  void Close() { EXPECT_EQ(process_->Do("close " + name_), "ok "); }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::shared_ptr<conformance::ProcessPeer> process_;
  std::string name_;
  std::uint32_t sequence_ = 0;
};

/// How many peers each topic of `grant` must have when these are on one network, and with it those
/// that hear themselves: writers count readers, readers writers.
inline Counts Expected(const security::RoleGrant& grant,
                       const std::vector<security::RoleGrant>& others) {
  Counts expected;
  for (const std::string& topic : security::TopicNames()) {
    Count& count = expected[topic];
    for (const security::RoleGrant& other : others) {
      count.writer_peers += Has(grant.publish, topic) && Has(other.subscribe, topic) ? 1 : 0;
      count.reader_peers += Has(grant.subscribe, topic) && Has(other.publish, topic) ? 1 : 0;
    }
    const bool itself = Has(grant.publish, topic) && Has(grant.subscribe, topic);
    count.writer_peers += itself ? 1 : 0;
    count.reader_peers += itself ? 1 : 0;
  }
  return expected;
}

/// "" when `now` has the peers of `expected`, else what differs.
inline std::string Difference(const Counts& now, const Counts& expected) {
  std::string text;
  for (const auto& [topic, count] : expected) {
    const auto found = now.find(topic);
    const Count is = found == now.end() ? Count{-1, -1, 0} : found->second;
    if (is.writer_peers != count.writer_peers || is.reader_peers != count.reader_peers) {
      text += topic + " has " + std::to_string(is.writer_peers) + '/' +
              std::to_string(is.reader_peers) + " peers, expected " +
              std::to_string(count.writer_peers) + '/' + std::to_string(count.reader_peers) + "; ";
    }
  }
  return text;
}

}  // namespace limbcast::security_test
