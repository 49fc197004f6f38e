#include "common/security/create.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "common/security/certificates.hpp"
#include "common/security/credentials.hpp"
#include "common/security/signed_document.hpp"

namespace limbcast::security {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kForAll = 0644;
constexpr mode_t kForOwner = 0600;

fs::path AuthorityKey(const fs::path& folder) { return folder / "private" / "ca.key"; }

Error CannotWrite(const fs::path& path, int code) {
  return Error{ErrorCode::kUnavailable,
               "security: " + path.string() + " cannot be written: " +
                   std::error_code(code, std::generic_category()).message()};
}

// The mode holds from the first byte on: nobody can open a key before it is closed to them.
Status Write(const fs::path& path, const std::string& text, mode_t mode) {
  std::error_code ignored;
  fs::remove(path, ignored);
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file < 0) {
    return CannotWrite(path, errno);
  }
  const ssize_t written = write(file, text.data(), text.size());
  const int code = written < 0 ? errno : ENOSPC;
  if (close(file) != 0 || written != static_cast<ssize_t>(text.size())) {
    return CannotWrite(path, code);
  }
  return Ok();
}

Status MakeFolder(const fs::path& path, mode_t mode) {
  if (mkdir(path.c_str(), mode) != 0 && errno != EEXIST) {
    return CannotWrite(path, errno);
  }
  return Ok();
}

Status WriteRole(const fs::path& folder, const Identity& authority, const RoleGrant& grant,
                 Library library, const Validity& validity) {
  const auto identity =
      MakeIdentity(authority, grant.role + "-" + NameOf(library), library, validity);
  if (!identity) {
    return identity.error();
  }
  const auto permissions =
      Sign(authority, PermissionsXml(grant, SubjectOf(*identity->certificate), validity));
  if (!permissions) {
    return permissions.error();
  }
  const CredentialFiles files = FilesOf(folder, grant.role, library);
  Status written = MakeFolder(folder / grant.role, 0755);
  written = written ? Write(files.key, ToPem(*identity->key), kForOwner) : written;
  written = written ? Write(files.certificate, ToPem(*identity->certificate), kForAll) : written;
  return written ? Write(files.permissions, *permissions, kForAll) : written;
}

Status WriteRoles(const fs::path& folder, const Identity& authority, const CreateOptions& options) {
  const auto governance = Sign(authority, GovernanceXml());
  if (!governance) {
    return governance.error();
  }
  if (Status written = Write(folder / "governance.p7s", *governance, kForAll); !written) {
    return written;
  }
  for (const RoleGrant& grant : options.roles) {
    for (const Library library : {Library::kCyclone, Library::kFast}) {
      Status written = WriteRole(folder, authority, grant, library, options.identities);
      if (!written) {
        return written;
      }
    }
  }
  return Ok();
}

Result<Identity> LoadAuthority(const fs::path& folder) {
  const auto certificate_pem = ReadFile(folder / "ca.pem");
  if (!certificate_pem) {
    return certificate_pem.error();
  }
  const auto key_pem = ReadFile(AuthorityKey(folder));
  if (!key_pem) {
    return key_pem.error();
  }
  auto certificate = CertificateFromPem(*certificate_pem);
  auto key = KeyFromPem(*key_pem);
  if (!certificate || !key || !IsKeyOf(**key, **certificate)) {
    return Error{ErrorCode::kCorruptData, "security: " + AuthorityKey(folder).string() +
                                              " is not the key of " + (folder / "ca.pem").string()};
  }
  return Identity{std::move(key).value(), std::move(certificate).value()};
}

}  // namespace

Status Create(const fs::path& folder, const CreateOptions& options) {
  std::error_code error;
  if (fs::exists(folder, error) &&
      !(fs::is_directory(folder, error) && fs::is_empty(folder, error))) {
    return Error{ErrorCode::kInvalidArgument,
                 "security: " + folder.string() +
                     " is there already; `limbcast security renew` keeps its authority"};
  }
  fs::create_directories(folder, error);
  if (error) {
    return CannotWrite(folder, error.value());
  }
  const auto authority = MakeAuthority("limbcast-ca", options.authority);
  if (!authority) {
    return authority.error();
  }
  Status written = MakeFolder(folder / "private", 0700);
  written = written ? Write(AuthorityKey(folder), ToPem(*authority->key), kForOwner) : written;
  written = written ? Write(folder / "ca.pem", ToPem(*authority->certificate), kForAll) : written;
  return written ? WriteRoles(folder, *authority, options) : written;
}

Status Renew(const fs::path& folder, const CreateOptions& options) {
  const auto authority = LoadAuthority(folder);
  return authority ? WriteRoles(folder, *authority, options) : Status(authority.error());
}

}  // namespace limbcast::security
