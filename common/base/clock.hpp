#pragma once

#include "common/base/time.hpp"

namespace limbcast {

/// Where "now" comes from. Chosen in main(); tests step a fake one. Implementations are
/// thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual Time Now() const = 0;
};

}  // namespace limbcast
