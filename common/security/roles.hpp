#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace limbcast::security {

/// What the bearer of a role may do: short names of topics ("skeleton"), ascending.
struct RoleGrant {
  std::string role;  ///< also the name of its folder
  std::vector<std::string> publish;
  std::vector<std::string> subscribe;
};

/// The roles of a deployment. gateway, fusion, posture, session: the services; pipeline: the first
/// three in one process; operator: sees all, commands; performer: joins and commands; spectator:
/// sees people, publishes nothing at all.
[[nodiscard]] const std::vector<RoleGrant>& DefaultRoles();

/// Every topic that a role may be granted.
[[nodiscard]] const std::vector<std::string>& TopicNames();

/// The role of DefaultRoles with that name; null when there is none.
[[nodiscard]] const RoleGrant* FindRole(std::string_view role);

}  // namespace limbcast::security
