#include "common/security/roles.hpp"

#include <algorithm>
#include <set>

namespace limbcast::security {
namespace {

using Names = std::vector<std::string>;

Names Sorted(std::initializer_list<Names> lists) {
  std::set<std::string> all;
  for (const Names& list : lists) {
    all.insert(list.begin(), list.end());
  }
  return {all.begin(), all.end()};
}

std::vector<RoleGrant> MakeRoles() {
  const Names sensing = {"marg",   "marg_frame",   "orientation", "coil_burst",
                         "marker", "position_fix", "sensor_info"};
  const Names people = {"body_definition", "skeleton", "joint_angles",
                        "roster",          "session",  "health"};
  const Names answers = {"join_reply", "command_reply"};
  const Names member = {"join_request", "command"};
  const Names health = {"health"};

  // Without a session host the gateway says who wears what; the simulator also tells the truth.
  const Names gateway_out = Sorted({sensing, member, {"roster", "truth"}, health});
  const Names gateway_in = Sorted(
      {answers,
       {"roster", "session", "segment_frame", "segment_state", "skeleton", "body_definition"}});
  const Names fusion_out = Sorted({{"segment_frame", "segment_state", "command_reply"}, health});
  const Names fusion_in = Sorted(
      {sensing,
       {"roster", "session", "command", "body_definition", "segment_frame", "segment_state"}});
  const Names posture_out =
      Sorted({{"body_definition", "command_reply", "joint_angles", "skeleton"}, health});
  const Names posture_in =
      Sorted({{"body_definition", "command", "position_fix", "roster", "segment_frame",
               "segment_state", "sensor_info", "session", "skeleton"}});
  return {
      {"gateway", gateway_out, gateway_in},
      {"fusion", fusion_out, fusion_in},
      {"posture", posture_out, posture_in},
      {"session", Sorted({answers, {"roster", "session"}, health}),
       Sorted({member, {"roster", "session"}})},
      {"pipeline", Sorted({gateway_out, fusion_out, posture_out}),
       Sorted({gateway_in, fusion_in, posture_in})},
      {"operator", Sorted({member, health}), TopicNames()},
      {"performer", Sorted({member}), Sorted({people, answers})},
      {"spectator", {}, Sorted({people})},
  };
}

}  // namespace

const std::vector<std::string>& TopicNames() {
  static const auto* names =
      new Names{// NOLINT: buses may be static objects
                "body_definition", "coil_burst",   "command",      "command_reply", "health",
                "join_reply",      "join_request", "joint_angles", "marg",          "marg_frame",
                "marker",          "orientation",  "position_fix", "roster",        "segment_frame",
                "segment_state",   "sensor_info",  "session",      "skeleton",      "truth"};
  return *names;
}

const std::vector<RoleGrant>& DefaultRoles() {
  static const auto* roles = new std::vector<RoleGrant>(MakeRoles());  // NOLINT: as above
  return *roles;
}

const RoleGrant* FindRole(std::string_view role) {
  const auto& roles = DefaultRoles();
  const auto found = std::find_if(roles.begin(), roles.end(),
                                  [&](const RoleGrant& grant) { return grant.role == role; });
  return found == roles.end() ? nullptr : &*found;
}

}  // namespace limbcast::security
