#pragma once

#include <initializer_list>
#include <string_view>

#include "common/base/result.hpp"

namespace limbcast {

/// A number and what it may be.
struct RangedValue {
  std::string_view name;
  double value = 0.0;
  double min = 0.0;
  double max = 0.0;
};

/// kInvalidArgument for the first value that is not in [min, max] (NaN never is):
/// "<prefix><name> must be in [<min>, <max>], is <value>".
[[nodiscard]] Status CheckRanges(std::string_view prefix,
                                 std::initializer_list<RangedValue> values);

}  // namespace limbcast
