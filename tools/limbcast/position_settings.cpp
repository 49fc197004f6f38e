#include "tools/limbcast/position_settings.hpp"

#include <utility>
#include <vector>

namespace limbcast::tool {

Result<filters::OpticalInertialConfig> PositionConfigFrom(std::span<const std::string> texts) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      return Error{ErrorCode::kInvalidArgument, "--set must be key=value, is '" + text + "'"};
    }
    settings.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return filters::ConfigFromSettings<filters::OpticalInertialConfig>(
      "optical_inertial", filters::OpticalInertialFields(), settings);
}

}  // namespace limbcast::tool
