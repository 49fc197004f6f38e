#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/security/documents.hpp"
#include "common/security/roles.hpp"

namespace limbcast::security {

struct CreateOptions {
  std::vector<RoleGrant> roles = DefaultRoles();
  Validity authority;   ///< of the CA
  Validity identities;  ///< of identities and permissions
};

/// Makes a folder with an authority, governance, and an identity and permissions for each role and
/// DDS library (README of this room). Private keys are readable by their owner only. `folder` must
/// not exist or be empty. Fails with kInvalidArgument (something is in it) or kUnavailable (it
/// cannot be written).
[[nodiscard]] Status Create(const std::filesystem::path& folder, const CreateOptions& options);

/// New identities and permissions for every role, by the authority that is in the folder: old and
/// new ones get on with each other until the old ones expire. `options.authority` is not used.
/// Fails with kNotFound or kCorruptData (no authority with its key) or kUnavailable.
[[nodiscard]] Status Renew(const std::filesystem::path& folder, const CreateOptions& options);

}  // namespace limbcast::security
