#include "services/fusion/router.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/expects.hpp"

namespace limbcast::fusion {

Router::Router(const FusionConfig& config, std::size_t workers)
    : workers_(workers), default_choice_(config.filter), segment_choices_(config.segment_filters) {
  Expects(workers_ >= 1, "at least one worker");
}

Router::Route* Router::Find(SensorUid sensor_uid) {
  const auto found = routes_.find(sensor_uid);
  return found == routes_.end() ? nullptr : &found->second;
}

FilterChoice Router::ChoiceFor(BodyId body_id, body::Segment segment) const {
  if (const auto found = body_choices_.find({body_id, segment}); found != body_choices_.end()) {
    return found->second;
  }
  const auto found = segment_choices_.find(segment);
  return found == segment_choices_.end() ? default_choice_ : found->second;
}

BodyPlan Router::MakePlan(BodyId body_id) const {
  BodyPlan plan{.body_id = body_id, .tracks = {}};
  const auto body = bodies_.find(body_id);
  if (body == bodies_.end()) {
    return plan;
  }
  for (const auto& [segment, sensor_uid] : body->second) {
    plan.tracks.push_back({.sensor_uid = sensor_uid,
                           .segment = segment,
                           .filters = ChoiceFor(body_id, segment),
                           .overloads = routes_.at(sensor_uid).overloads});
  }
  return plan;
}

std::vector<BodyPlan> Router::Apply(const roster::RosterEntry& entry) {
  Assignments wanted;
  for (const roster::SensorAssignment& assignment : entry.sensors) {
    const bool known = body::Index(assignment.segment) < body::kSegmentCount;
    bool free = assignment.sensor_uid.value != 0 && known;
    for (const auto& [segment, sensor_uid] : wanted) {
      free = free && sensor_uid != assignment.sensor_uid && segment != assignment.segment;
    }
    if (free) {
      wanted.emplace(assignment.segment, assignment.sensor_uid);
    } else {
      ++refused_assignments_;
    }
  }
  const auto existing = bodies_.find(entry.body_id);
  if (existing != bodies_.end() && existing->second == wanted) {
    return {};
  }

  const auto wants = [&wanted](const auto& assignment) {
    return std::any_of(wanted.begin(), wanted.end(),
                       [&](const auto& mine) { return mine.second == assignment.second; });
  };
  std::vector<BodyPlan> plans;
  // Sensors that it no longer has.
  if (existing != bodies_.end()) {
    for (const auto& assignment : existing->second) {
      if (!wants(assignment)) {
        routes_.erase(assignment.second);
      }
    }
  }
  // Sensors that it takes from others.
  for (auto& [other_id, assignments] : bodies_) {
    if (other_id == entry.body_id) {
      continue;
    }
    if (std::erase_if(assignments, wants) > 0) {
      plans.push_back(MakePlan(other_id));
    }
  }
  for (const auto& [segment, sensor_uid] : wanted) {
    Route& route = routes_[sensor_uid];
    route.body_id = entry.body_id;
    route.worker = WorkerOf(entry.body_id);
  }
  bodies_[entry.body_id] = std::move(wanted);
  plans.push_back(MakePlan(entry.body_id));
  return plans;
}

std::vector<BodyPlan> Router::Remove(BodyId body_id) {
  const auto body = bodies_.find(body_id);
  if (body == bodies_.end()) {
    return {};
  }
  for (const auto& [segment, sensor_uid] : body->second) {
    routes_.erase(sensor_uid);
  }
  bodies_.erase(body);
  std::erase_if(body_choices_, [&](const auto& choice) { return choice.first.first == body_id; });
  return {BodyPlan{.body_id = body_id, .tracks = {}}};
}

Result<std::vector<BodyPlan>> Router::Select(BodyId body_id,
                                             std::span<const body::Segment> segments,
                                             std::uint8_t slot, const std::string& name) {
  Expects(slot <= 1, "slot 0 or 1");
  const bool all_bodies = body_id.value == 0;
  if (!all_bodies && !bodies_.contains(body_id)) {
    return Error{ErrorCode::kNotFound, fmt::format("body {} is not in the roster", body_id.value)};
  }
  const auto change = [&](FilterChoice& choice) {
    (slot == 0 ? choice.name : choice.beside) = name;
  };
  if (segments.empty()) {
    segments = body::AllSegments();
    if (all_bodies) {
      change(default_choice_);  // bodies yet to come
    }
  }
  for (const body::Segment segment : segments) {
    if (all_bodies) {
      FilterChoice choice =
          segment_choices_.contains(segment) ? segment_choices_[segment] : default_choice_;
      change(choice);
      segment_choices_[segment] = choice;
      for (auto& [place, of_body] : body_choices_) {
        if (place.second == segment) {
          change(of_body);
        }
      }
    } else {
      FilterChoice choice = ChoiceFor(body_id, segment);
      change(choice);
      body_choices_[{body_id, segment}] = choice;
    }
  }
  std::vector<BodyPlan> plans;
  for (const auto& [id, assignments] : bodies_) {
    if (all_bodies || id == body_id) {
      plans.push_back(MakePlan(id));
    }
  }
  return plans;
}

}  // namespace limbcast::fusion
