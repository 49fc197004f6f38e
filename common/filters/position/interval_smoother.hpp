#pragma once

#include <span>
#include <vector>

#include "common/filters/position/optical_outputs.hpp"

namespace limbcast::filters {

/// A forward pass with all that smoothing it needs; about 11 kB for each epoch.
class OpticalHistory {
 public:
  void Reserve(std::size_t epochs);
  void Push(const OpticalEpoch& epoch);

  [[nodiscard]] std::span<const PositionEstimate> forward() const { return forward_; }

  /// Fixed-interval smoothing from the last epoch (design/position.md section 5). One estimate for
  /// each epoch; fill kind kInertialForward stays only after the last marker.
  [[nodiscard]] std::vector<PositionEstimate> Smooth() const;

  /// The smoothed state of the first epoch, with all error states: where another pass may
  /// linearise.
  [[nodiscard]] OpticalInertialState SmoothedStart() const;

 private:
  struct Chain {
    std::size_t first = 0;
    OpticalInertialState state;
    optical::Covariance P;
  };
  struct Stored {
    optical::Record record;
    optical::OutputRows rows;
  };
  std::vector<Stored> stored_;
  std::vector<PositionEstimate> forward_;
  std::vector<Chain> chains_;
};

}  // namespace limbcast::filters
