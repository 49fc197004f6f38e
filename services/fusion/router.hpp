#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/base/ids.hpp"
#include "common/base/result.hpp"
#include "common/body/segment.hpp"
#include "common/roster/roster.hpp"
#include "services/fusion/fusion_config.hpp"

namespace limbcast::fusion {

/// One sensor of a body as a worker runs it.
struct TrackPlan {
  SensorUid sensor_uid;
  body::Segment segment = body::Segment::kPelvis;
  FilterChoice filters;
  std::uint64_t overloads = 0;  ///< of this sensor so far, see Router::Route
};

/// All sensors of one body: replaces what the worker had of it. No tracks: the body is gone.
struct BodyPlan {
  BodyId body_id;
  std::vector<TrackPlan> tracks;
};

/// Who is who, and which filter runs where: roster and filter choices become plans for workers, and
/// a sensor's uid leads to its worker. Thread-compatible; allocates only when something changes.
class Router {
 public:
  struct Route {
    BodyId body_id;
    std::size_t worker = 0;
    std::uint64_t overloads = 0;  ///< samples refused because the worker's queue was full
  };

  Router(const FusionConfig& config, std::size_t workers);

  /// A body always runs on the same worker, so its samples stay in order.
  [[nodiscard]] std::size_t WorkerOf(BodyId body_id) const { return body_id.value % workers_; }

  /// Null: no roster entry knows the sensor.
  [[nodiscard]] Route* Find(SensorUid sensor_uid);

  /// A new or changed roster entry. A sensor belongs to the body that named it last. Gives the
  /// plans of all bodies that changed; none when nothing did.
  [[nodiscard]] std::vector<BodyPlan> Apply(const roster::RosterEntry& entry);

  /// The body left.
  [[nodiscard]] std::vector<BodyPlan> Remove(BodyId body_id);

  /// Another filter (slot 0) or another one beside it (slot 1; "" = none) from now on: for all
  /// bodies when body_id is 0, for all segments when `segments` is empty. `name` must be one that
  /// can be made. Fails with kNotFound for a body that is not in the roster.
  [[nodiscard]] Result<std::vector<BodyPlan>> Select(BodyId body_id,
                                                     std::span<const body::Segment> segments,
                                                     std::uint8_t slot, const std::string& name);

  [[nodiscard]] std::size_t body_count() const { return bodies_.size(); }
  [[nodiscard]] std::size_t sensor_count() const { return routes_.size(); }
  /// Assignments that were left out (segment named twice in one entry, sensor 0), ever.
  [[nodiscard]] std::uint64_t refused_assignments() const { return refused_assignments_; }

 private:
  using Assignments = std::map<body::Segment, SensorUid>;
  [[nodiscard]] BodyPlan MakePlan(BodyId body_id) const;
  [[nodiscard]] FilterChoice ChoiceFor(BodyId body_id, body::Segment segment) const;

  const std::size_t workers_;
  FilterChoice default_choice_;
  std::map<body::Segment, FilterChoice> segment_choices_;                  // of every body
  std::map<std::pair<BodyId, body::Segment>, FilterChoice> body_choices_;  // by command
  std::map<BodyId, Assignments> bodies_;
  std::unordered_map<SensorUid, Route> routes_;
  std::uint64_t refused_assignments_ = 0;
};

}  // namespace limbcast::fusion
