#pragma once

#include <filesystem>
#include <string>

#include "common/base/result.hpp"
#include "common/base/time.hpp"
#include "common/security/certificates.hpp"

namespace limbcast::security {

/// The files that one process hands to its DDS library, absolute.
struct CredentialFiles {
  std::filesystem::path authority;    ///< CA of identities and of documents
  std::filesystem::path governance;   ///< signed
  std::filesystem::path certificate;  ///< identity
  std::filesystem::path key;          ///< of the identity
  std::filesystem::path permissions;  ///< signed
};

/// Where they lie in a folder made by Create.
[[nodiscard]] CredentialFiles FilesOf(const std::filesystem::path& folder, const std::string& role,
                                      Library library);

/// The files of a role, after everything in them was found to be in order at `now`. Fails with
/// kNotFound (a file that is not there or cannot be read), kCorruptData (not what it should be,
/// signed by another authority, a key or permissions of somebody else) or kInvalidArgument (expired
/// or not valid yet, a subject that the other library could not talk to); the message begins with
/// "security: " and names the file.
[[nodiscard]] Result<CredentialFiles> CheckCredentials(const std::filesystem::path& folder,
                                                       const std::string& role, Library library,
                                                       Time now);

/// Until when the identity of a role is valid. As CheckCredentials, but dates are not judged.
[[nodiscard]] Result<Validity> ValidityOf(const std::filesystem::path& folder,
                                          const std::string& role, Library library);

/// All of a file; kNotFound with its name and the reason.
[[nodiscard]] Result<std::string> ReadFile(const std::filesystem::path& path);

}  // namespace limbcast::security
