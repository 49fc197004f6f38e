#include "services/gateway/coil_grants.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace limbcast::gateway {
namespace {

// Nothing when none is granted, or what is written there is no grant.
std::optional<sensing::CoilGrant> GrantOf(const roster::RosterEntry& entry) {
  const Duration frame = std::chrono::microseconds(entry.coil_frame_us);
  if (entry.coil_slot == 0 || entry.coil_slot > entry.coil_slots ||
      frame < entry.coil_slots * std::chrono::microseconds(1)) {
    return std::nullopt;
  }
  return sensing::CoilGrant{.slot = entry.coil_slot - 1, .slots = entry.coil_slots, .frame = frame};
}

}  // namespace

Result<std::unique_ptr<CoilGrants>> CoilGrants::Make(bus::Bus& bus, std::vector<BodyId> own) {
  std::unique_ptr<CoilGrants> grants(new CoilGrants(std::move(own)));
  auto reader = bus.MakeReader<roster::RosterEntry>(
      {.on_sample = [raw = grants.get()](const roster::RosterEntry& entry,
                                         const bus::SampleInfo&) { raw->Take(entry); },
       .on_disposed =
           [raw = grants.get()](const roster::RosterEntry& entry) { raw->Forget(entry.body_id); }});
  if (!reader) {
    return reader.error();
  }
  grants->reader_ = std::move(*reader);
  return grants;
}

std::shared_ptr<const CoilSchedule> CoilGrants::schedule() const {
  const std::scoped_lock lock(mutex_);
  return schedule_;
}

void CoilGrants::Take(const roster::RosterEntry& entry) {
  const std::optional<sensing::CoilGrant> grant = GrantOf(entry);
  if (!grant) {
    Forget(entry.body_id);
    return;
  }
  const std::scoped_lock lock(mutex_);
  const auto [known, is_new] = granted_.try_emplace(entry.body_id, *grant);
  if (is_new || known->second != *grant) {
    known->second = *grant;
    Rebuild();
  }
}

void CoilGrants::Forget(BodyId body) {
  const std::scoped_lock lock(mutex_);
  if (granted_.erase(body) > 0) {
    Rebuild();
  }
}

bool CoilGrants::IsOwn(BodyId body) const {
  return std::find(own_.begin(), own_.end(), body) != own_.end();
}

bool CoilGrants::Yields(BodyId body, const sensing::CoilGrant& grant) const {
  const auto before = std::find_if(granted_.begin(), granted_.end(), [&](const auto& other) {
    return other.first < body && !IsOwn(other.first) && other.second == grant;
  });
  if (before == granted_.end()) {
    return false;
  }
  spdlog::warn(
      "body {} has the same coil slot as body {} of another gateway: its coils do not pulse",
      body.value, before->first.value);
  return true;
}

void CoilGrants::Rebuild() {
  auto schedule = std::make_shared<CoilSchedule>();
  for (const BodyId body : own_) {
    const auto granted = granted_.find(body);
    const bool may = granted != granted_.end() && !Yields(body, granted->second);
    schedule->own.push_back(
        {.body_id = body, .grant = may ? std::optional(granted->second) : std::nullopt});
  }
  for (const auto& [body, grant] : granted_) {
    if (!IsOwn(body)) {
      schedule->foreign.push_back(grant);
    }
  }
  schedule_ = std::move(schedule);
}

}  // namespace limbcast::gateway
