#include "services/gateway/ack_window.hpp"

#include <algorithm>

#include "common/base/expects.hpp"

namespace limbcast::gateway {

AckWindow::AckWindow(std::size_t depth, Duration deadline, Older older)
    : depth_(depth), deadline_(deadline), older_(older) {
  Expects(depth_ >= 1, "a window of at least one");
}

std::size_t AckWindow::AddLane(bool expected) {
  lanes_.emplace_back();
  lanes_.back().ring.resize(depth_);
  SetState(lanes_.back(), expected ? State::kAnswering : State::kNotExpected);
  return lanes_.size() - 1;
}

void AckWindow::SetState(Lane& lane, State state) {
  answering_ -= lane.state == State::kAnswering ? 1U : 0U;
  answering_ += state == State::kAnswering ? 1U : 0U;
  lane.state = state;
}

void AckWindow::Pop(Lane& lane, bool as_lost) {
  full_lanes_ -= lane.size == depth_ ? 1U : 0U;
  lane.begin = (lane.begin + 1) % depth_;
  --lane.size;
  --under_way_;
  if (as_lost) {
    ++lane.lost;
    ++lost_;
  }
}

void AckWindow::Sent(std::size_t index, std::int64_t token, Time now) {
  Lane& lane = lanes_[index];
  if (lane.state == State::kNotExpected) {
    return;
  }
  lane.newest = token;
  if (lane.state == State::kSilent) {
    ++lane.lost;
    ++lost_;
    return;
  }
  if (lane.size == depth_) {
    Pop(lane, true);
  }
  lane.ring[(lane.begin + lane.size) % depth_] = {.token = token, .sent_at = now};
  ++lane.size;
  ++under_way_;
  full_lanes_ += lane.size == depth_ ? 1U : 0U;
}

bool AckWindow::Answered(std::size_t index, std::int64_t token) {
  Lane& lane = lanes_[index];
  const bool was_silent = lane.state == State::kSilent;
  SetState(lane, State::kAnswering);
  while (lane.size > 0 && Oldest(lane).token < token) {
    Pop(lane, older_ == Older::kLost);
  }
  if (lane.size > 0 && Oldest(lane).token == token) {
    Pop(lane, false);
    return true;
  }
  if (was_silent && token == lane.newest && lane.lost > 0) {  // was counted too early
    --lane.lost;
    --lost_;
    return true;
  }
  ++late_;
  return false;
}

std::uint64_t AckWindow::Expire(Time now) {
  std::uint64_t expired = 0;
  for (Lane& lane : lanes_) {
    if (lane.size == 0 || now - Oldest(lane).sent_at < deadline_) {
      continue;
    }
    SetState(lane, State::kSilent);
    while (lane.size > 0) {  // the younger ones hold nobody up either
      Pop(lane, true);
      ++expired;
    }
  }
  return expired;
}

void AckWindow::Silence() {
  for (Lane& lane : lanes_) {
    if (lane.state == State::kAnswering) {
      SetState(lane, State::kSilent);
    }
    while (lane.size > 0) {
      Pop(lane, true);
    }
  }
}

std::optional<Time> AckWindow::NextDeadline() const {
  std::optional<Time> next;
  for (const Lane& lane : lanes_) {
    if (lane.size > 0) {
      const Time deadline = Oldest(lane).sent_at + deadline_;
      next = next ? std::min(*next, deadline) : deadline;
    }
  }
  return next;
}

}  // namespace limbcast::gateway
