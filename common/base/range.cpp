#include "common/base/range.hpp"

#include <string>

namespace limbcast {

Status CheckRanges(std::string_view prefix, std::initializer_list<RangedValue> values) {
  for (const RangedValue& checked : values) {
    if (!(checked.value >= checked.min && checked.value <= checked.max)) {
      return Error{ErrorCode::kInvalidArgument, std::string(prefix) + std::string(checked.name) +
                                                    " must be in [" + std::to_string(checked.min) +
                                                    ", " + std::to_string(checked.max) + "], is " +
                                                    std::to_string(checked.value)};
    }
  }
  return Ok();
}

}  // namespace limbcast
