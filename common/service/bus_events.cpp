#include "common/service/bus_events.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

namespace limbcast::service {

namespace {

using bus::BusEventKind;

// These tell a state ("how many now"); the others tell how many more.
bool TellsHowManyNow(BusEventKind kind) {
  return kind == BusEventKind::kMatched || kind == BusEventKind::kUnmatched ||
         kind == BusEventKind::kLivelinessLost || kind == BusEventKind::kLivelinessGained;
}

bool IsNews(BusEventKind kind) {
  return kind == BusEventKind::kMatched || kind == BusEventKind::kUnmatched ||
         kind == BusEventKind::kLivelinessGained;
}

}  // namespace

std::string Describe(const bus::BusEvent& event) {
  return fmt::format("{} on {} ({}, {} {}){}{}", bus::ToString(event.kind), event.topic,
                     event.from_writer ? "writer" : "reader",
                     TellsHowManyNow(event.kind) ? "now" : "count", event.count,
                     event.detail.empty() ? "" : ": ", event.detail);
}

void BusEvents::Note(const bus::BusEvent& event) {
  const auto more = TellsHowManyNow(event.kind)
                        ? std::uint64_t{1}
                        : static_cast<std::uint64_t>(std::max<std::int64_t>(event.count, 1));
  counts_[static_cast<std::size_t>(event.kind)].fetch_add(more, std::memory_order_relaxed);

  const std::scoped_lock lock(mutex_);
  if (event.kind == BusEventKind::kLivelinessLost || event.kind == BusEventKind::kIncompatibleQos ||
      event.kind == BusEventKind::kTypeMismatch) {
    last_error_ = "bus: " + Describe(event);
  } else if (event.kind == BusEventKind::kLivelinessGained) {
    last_error_.clear();
  }
  if (pending_.size() < kMaxPending) {
    pending_.push_back(event);
  } else {
    ++not_logged_;
  }
}

void BusEvents::Report(ServiceHealth& health) {
  std::vector<bus::BusEvent> pending;
  std::uint64_t not_logged = 0;
  {
    const std::scoped_lock lock(mutex_);
    pending.swap(pending_);
    not_logged = std::exchange(not_logged_, 0);
    if (health.last_error.empty()) {
      health.last_error = last_error_;
    }
  }
  for (std::size_t kind = 0; kind < bus::kBusEventKindCount; ++kind) {
    health.values.push_back({"bus." + std::string(bus::ToString(static_cast<BusEventKind>(kind))),
                             static_cast<double>(counts_[kind].load(std::memory_order_relaxed))});
  }
  for (const bus::BusEvent& event : pending) {
    spdlog::log(IsNews(event.kind) ? spdlog::level::info : spdlog::level::warn, "bus: {}",
                Describe(event));
  }
  if (not_logged > 0) {
    spdlog::warn("bus: {} more events within one second, counted only", not_logged);
  }
}

}  // namespace limbcast::service
