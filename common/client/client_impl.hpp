#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.hpp"
#include "common/body/forward_kinematics.hpp"
#include "common/bus/bus.hpp"
#include "common/client/client.hpp"
#include "common/client/requester.hpp"
#include "common/client/session_member.hpp"
#include "common/client/skeleton_history.hpp"

namespace limbcast::client {

[[nodiscard]] inline SessionStanding StandingOf(const MemberStatus& status) {
  return {.member = status.state == MemberState::kMember,
          .body_id = status.body_id,
          .message = status.message};
}

/// What is behind a Client; apart from client.hpp, which shows no DDS.
class Client::Impl {
 public:
  Impl(std::unique_ptr<Clock> own_clock, const Clock* clock, const ClientOptions& options)
      : own_clock_(std::move(own_clock)),
        clock_(clock != nullptr ? *clock : *own_clock_),
        options_(options) {}

  void Own(std::unique_ptr<bus::Bus> bus) { own_bus_ = std::move(bus); }
  Status Join(bus::Bus& bus);

  [[nodiscard]] const Clock& clock() const { return clock_; }
  [[nodiscard]] std::vector<BodyId> Bodies() const;
  [[nodiscard]] std::optional<body::BodyDefinition> Definition(BodyId body_id) const;
  [[nodiscard]] std::optional<body::Skeleton> Latest(BodyId body_id) const;
  [[nodiscard]] std::optional<Pose> PoseAt(BodyId body_id, Time at) const;
  void OnSkeleton(std::function<void(const body::Skeleton&)> callback) {
    const std::scoped_lock lock(callback_mutex_);
    on_skeleton_ = std::move(callback);
  }
  void OnBody(std::function<void(const body::BodyDefinition&, bool)> callback) {
    const std::scoped_lock lock(callback_mutex_);
    on_body_ = std::move(callback);
  }
  void OnStanding(std::function<void(const SessionStanding&)> callback) {
    const std::scoped_lock lock(callback_mutex_);
    on_standing_ = std::move(callback);
  }
  [[nodiscard]] std::optional<roster::RosterEntry> Entry(BodyId body_id) const {
    const std::scoped_lock lock(mutex_);
    const auto entry = roster_.find(body_id);
    return entry == roster_.end() ? std::nullopt : std::optional(entry->second);
  }
  [[nodiscard]] SessionStanding Standing() const {
    return member_ == nullptr ? SessionStanding() : StandingOf(member_->status(0));
  }
  Status AskHost(roster::CommandKind kind, const std::string& text, Duration timeout);
  Result<roster::CommandReply> Send(roster::Command command, Duration timeout);
  [[nodiscard]] std::string Describe() const { return bus_->Describe(); }

 private:
  struct Person {
    explicit Person(std::size_t history) : skeletons(history) {}
    std::optional<body::BodyDefinition> definition;
    std::optional<body::ForwardKinematics> kinematics;  // of the definition
    SkeletonHistory skeletons;
    // Out of the roster. The posture service disposes of the definition then, but not one that has
    // fallen meanwhile; and the news of either may come first.
    bool left = false;
  };
  Person& Of(BodyId body_id) {
    return people_.try_emplace(body_id, options_.history).first->second;
  }
  // With mutex_ held; null for who is not there.
  [[nodiscard]] const Person* Find(BodyId body_id) const {
    const auto found = people_.find(body_id);
    return found == people_.end() || found->second.left ? nullptr : &found->second;
  }
  void Take(const roster::RosterEntry& entry);
  void Leave(BodyId body_id);
  void Tell(const body::BodyDefinition& definition, bool present);
  void Take(const body::Skeleton& skeleton);
  void Take(const body::BodyDefinition& definition);
  void Remove(const body::BodyDefinition& key);
  void Take(const MemberStatus& status);
  Status JoinSession(bus::Bus& bus);

  const std::unique_ptr<Clock> own_clock_;
  const Clock& clock_;
  const ClientOptions options_;

  std::mutex callback_mutex_;  // held during callbacks; taken before mutex_ or alone
  std::function<void(const body::Skeleton&)> on_skeleton_;
  std::function<void(const body::BodyDefinition&, bool)> on_body_;
  std::function<void(const SessionStanding&)> on_standing_;

  mutable std::mutex mutex_;  // guards all below it but the endpoints; never held in a callback
  std::condition_variable changed_;
  std::map<BodyId, Person> people_;
  std::map<BodyId, roster::RosterEntry> roster_;

  std::unique_ptr<bus::Bus> own_bus_;  // outlives the endpoints, which are declared after it
  bus::Bus* bus_ = nullptr;
  std::unique_ptr<Requester<roster::Command, roster::CommandReply>> commands_;
  std::unique_ptr<bus::Reader<roster::RosterEntry>> entries_;
  std::unique_ptr<bus::Reader<body::BodyDefinition>> definitions_;
  std::unique_ptr<bus::Reader<body::Skeleton>> skeletons_;
  std::unique_ptr<SessionMember> member_;  // null: in no session
};

}  // namespace limbcast::client
