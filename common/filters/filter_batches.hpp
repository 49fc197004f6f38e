#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "common/filters/batch_kernels.hpp"
#include "common/filters/filter.hpp"
#include "common/filters/sensor_batch.hpp"

namespace limbcast::filters {

/// The batches of one thread: seats filters of the same kind and configuration together, as many
/// batches as it takes. Thread-compatible, and so are the filters seated here, with each other.
class FilterBatches {
 public:
  /// @param kernels  of an instruction set that this machine has; static storage.
  explicit FilterBatches(const BatchKernels& kernels = BestKernels()) : kernels_(kernels) {}

  /// The filter, seated in a batch when it is of a kind that has them ("tqt" in its reduced form,
  /// "bmf", "bmf-plain"), itself otherwise. May be called at any time but between Submit and Take.
  [[nodiscard]] std::unique_ptr<OrientationFilter> Seat(std::unique_ptr<OrientationFilter> filter);

  /// Steps everything that was submitted. Allocates nothing.
  void Run();

  [[nodiscard]] std::size_t batch_count() const { return batches_.size(); }

 private:
  template <typename Filter>
  std::unique_ptr<OrientationFilter> SeatAs(std::unique_ptr<OrientationFilter>& filter,
                                            typename SensorBatch<Filter>::Kernel kernel, int width);

  const BatchKernels& kernels_;
  std::vector<std::shared_ptr<AnySensorBatch>> batches_;
};

}  // namespace limbcast::filters
