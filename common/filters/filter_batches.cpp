#include "common/filters/filter_batches.hpp"

#include <utility>

#include "common/filters/bounded_motion_filter.hpp"
#include "common/filters/gauss_newton_orientation.hpp"

namespace limbcast::filters {
namespace {

// The 4×4 form of the Gauss–Newton step is there for one sensor only.
template <typename Scalar>
bool HasNoLanes(const OrientationFilter& filter) {
  const auto* const tqt = dynamic_cast<const GaussNewtonOrientation<Scalar>*>(&filter);
  return tqt != nullptr && tqt->config().form != GaussNewtonForm::kReduced3x3;
}

}  // namespace

template <typename Filter>
std::unique_ptr<OrientationFilter> FilterBatches::SeatAs(
    std::unique_ptr<OrientationFilter>& filter, typename SensorBatch<Filter>::Kernel kernel,
    int width) {
  auto* const own = dynamic_cast<Filter*>(filter.get());
  if (own == nullptr) {
    return nullptr;
  }
  std::shared_ptr<SensorBatch<Filter>> free;
  for (const auto& batch : batches_) {
    auto same = std::dynamic_pointer_cast<SensorBatch<Filter>>(batch);
    if (same != nullptr && same->seats_taken() < AnySensorBatch::kSeats &&
        same->config() == own->config()) {
      free = std::move(same);
      break;
    }
  }
  if (free == nullptr) {
    free = std::make_shared<SensorBatch<Filter>>(own->config(), kernel, width);
    batches_.push_back(free);
  }
  static_cast<void>(filter.release());
  return SensorBatch<Filter>::Seat(std::move(free), std::unique_ptr<Filter>(own));
}

std::unique_ptr<OrientationFilter> FilterBatches::Seat(std::unique_ptr<OrientationFilter> filter) {
  // Batches that nobody sits in any more go.
  std::erase_if(batches_, [](const auto& batch) { return batch->seats_taken() == 0; });
  if (HasNoLanes<double>(*filter) || HasNoLanes<float>(*filter)) {
    return filter;
  }
  auto seated = SeatAs<GaussNewtonOrientation<double>>(filter, kernels_.gauss_newton_double,
                                                       kernels_.width_double);
  if (seated == nullptr) {
    seated = SeatAs<GaussNewtonOrientation<float>>(filter, kernels_.gauss_newton_float,
                                                   kernels_.width_float);
  }
  if (seated == nullptr) {
    seated = SeatAs<BoundedMotionFilter<double>>(filter, kernels_.bounded_motion_double,
                                                 kernels_.width_double);
  }
  if (seated == nullptr) {
    seated = SeatAs<BoundedMotionFilter<float>>(filter, kernels_.bounded_motion_float,
                                                kernels_.width_float);
  }
  return seated != nullptr ? std::move(seated) : std::move(filter);
}

void FilterBatches::Run() {
  for (const auto& batch : batches_) {
    batch->Run();
  }
}

}  // namespace limbcast::filters
