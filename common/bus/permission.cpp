#include "common/bus/permission.hpp"

#include <algorithm>

#include "common/security/roles.hpp"

namespace limbcast::bus {

Error ExplainRefusal(const BusConfig& config, std::string_view verb, std::string_view short_topic,
                     Error refused) {
  if (config.security_dir.empty()) {
    return refused;
  }
  // Of a role that we do not know, the library's word is the only one.
  if (const security::RoleGrant* role = security::FindRole(config.security_role)) {
    const auto& granted = verb == "publish" ? role->publish : role->subscribe;
    if (std::find(granted.begin(), granted.end(), short_topic) != granted.end()) {
      return refused;
    }
  }
  return Error{ErrorCode::kInvalidArgument,
               "security: role \"" + config.security_role + "\" may not " + std::string(verb) +
                   ' ' + std::string(short_topic) + " (" + refused.message + ")"};
}

}  // namespace limbcast::bus
