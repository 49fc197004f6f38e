#pragma once

#include <string>

#include "common/base/time.hpp"
#include "common/security/roles.hpp"

namespace limbcast::security {

/// From when to when something is valid.
struct Validity {
  Time from;
  Time until;
};

/// The governance document, DDS Security 1.1, 9.4.1.2: one for all participants of a deployment.
[[nodiscard]] std::string GovernanceXml();

/// The permissions document of one subject, DDS Security 1.1, 9.4.1.3: what `grant` allows, in
/// every partition, and nothing else. `subject` is a name in the order of RFC 2253.
[[nodiscard]] std::string PermissionsXml(const RoleGrant& grant, const std::string& subject,
                                         const Validity& validity);

/// The text of the first element `name` of a document of ours; empty when there is none.
[[nodiscard]] std::string ElementOf(const std::string& xml, const std::string& name);

/// The subject that a permissions document is for; empty when it names none.
[[nodiscard]] std::string SubjectOf(const std::string& permissions_xml);

/// "2026-11-26T16:00:00", UTC, seconds cut off.
[[nodiscard]] std::string IsoText(Time time);

}  // namespace limbcast::security
