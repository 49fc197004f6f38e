#include "services/gateway/gateway_session.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "services/gateway/tick_source.hpp"

namespace limbcast::gateway {

Result<std::unique_ptr<GatewaySession>> GatewaySession::Make(bus::Bus& bus,
                                                             const GatewayConfig& config,
                                                             const DriverDescription& description) {
  std::unique_ptr<GatewaySession> session(new GatewaySession());
  if (!config.session_host) {
    return session;
  }
  if (description.bodies.empty()) {
    return Error{
        ErrorCode::kInvalidArgument,
        fmt::format("{} says of no sensor where it is worn: nobody can join session \"{}\" "
                    "(see --assign)",
                    description.source, config.session)};
  }
  std::vector<roster::RosterEntry> bodies = description.bodies;
  Name(config.person, bodies);
  std::vector<client::Membership> as;
  for (roster::RosterEntry& body : bodies) {
    session->people_.push_back(body.person);
    as.push_back({.role = roster::Role::kPerformer,
                  .person = std::move(body.person),
                  .sensors = std::move(body.sensors),
                  .wants_coil_slot = body.coil_slot != 0});
  }
  session->session_ = config.session;
  auto member = client::SessionMember::Make(
      bus, config.session, std::move(as),
      [people = session->people_](std::size_t index, const client::MemberStatus& status) {
        if (status.state == client::MemberState::kMember) {
          spdlog::info("\"{}\" is body {} of the session", people[index], status.body_id.value);
        } else {
          spdlog::warn("\"{}\" is not in the session: {}", people[index], status.message);
        }
      });
  if (!member) {
    return member.error();
  }
  session->member_ = std::move(*member);
  session->member_->Start();
  return session;
}

bool GatewaySession::Wait(const std::function<bool()>& stop) {
  constexpr auto kLookAgain = std::chrono::milliseconds(100);
  if (member_ == nullptr) {
    return true;
  }
  while (!stop()) {
    if (member_->WaitUntilJoined(kLookAgain)) {
      return true;
    }
  }
  return false;
}

std::vector<BodyId> GatewaySession::bodies() const {
  std::vector<BodyId> bodies;
  for (std::size_t i = 0; i < people_.size(); ++i) {
    bodies.push_back(member_->status(i).body_id);
  }
  return bodies;
}

std::string GatewaySession::Trouble() const {
  for (std::size_t i = 0; i < people_.size(); ++i) {
    const client::MemberStatus status = member_->status(i);
    if (status.state == client::MemberState::kAsking) {
      return fmt::format("waiting: no session host answers for session \"{}\"", session_);
    }
    if (status.state == client::MemberState::kRefused) {
      return fmt::format("session \"{}\" refuses \"{}\": {}", session_, people_[i], status.message);
    }
  }
  return {};
}

void GatewaySession::FillHealth(ServiceHealth& health) const {
  if (health.last_error.empty()) {
    health.last_error = Trouble();
  }
}

}  // namespace limbcast::gateway
