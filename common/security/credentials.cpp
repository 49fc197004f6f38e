#include "common/security/credentials.hpp"

#include <cerrno>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>

#include "common/security/signed_document.hpp"

namespace limbcast::security {
namespace {

namespace fs = std::filesystem;

Error About(ErrorCode code, const fs::path& file, const std::string& what) {
  return Error{code, "security: " + file.string() + " " + what};
}

Result<Certificate> LoadCertificate(const fs::path& file) {
  const auto pem = ReadFile(file);
  if (!pem) {
    return pem.error();
  }
  auto certificate = CertificateFromPem(*pem);
  return certificate ? std::move(certificate)
                     : Result<Certificate>(
                           About(ErrorCode::kCorruptData, file, certificate.error().message));
}

Result<std::string> LoadSigned(const fs::path& file, const X509& authority) {
  const auto document = ReadFile(file);
  if (!document) {
    return document.error();
  }
  auto text = ReadSigned(*document, authority);
  return text ? std::move(text)
              : Result<std::string>(About(ErrorCode::kCorruptData, file, text.error().message));
}

Error Expired(const fs::path& file, const std::string& until, Time now) {
  return About(ErrorCode::kInvalidArgument, file,
               "has expired at " + until + " UTC, now is " + IsoText(now) +
                   ": `limbcast security renew` makes new ones");
}

Status CheckDates(const fs::path& file, const Validity& validity, Time now) {
  if (now > validity.until) {
    return Expired(file, IsoText(validity.until), now);
  }
  if (now < validity.from) {
    return About(ErrorCode::kInvalidArgument, file,
                 "is not valid before " + IsoText(validity.from) + " UTC, now is " + IsoText(now) +
                     ": is the clock of this host right?");
  }
  return Ok();
}

Status CheckDates(const fs::path& file, const X509& certificate, Time now) {
  const auto validity = ValidityOf(certificate);
  return validity ? CheckDates(file, *validity, now)
                  : Status(About(ErrorCode::kCorruptData, file, "has no readable dates"));
}

Status CheckIdentity(const CredentialFiles& files, const X509& identity, const X509& authority,
                     Library library, Time now) {
  if (!IsSignedBy(identity, authority)) {
    return About(ErrorCode::kCorruptData, files.certificate,
                 "was not signed by " + files.authority.string() +
                     ": they come from different `limbcast security create`");
  }
  if (Status dates = CheckDates(files.certificate, identity, now); !dates) {
    return dates;
  }
  const auto pem = ReadFile(files.key);
  if (!pem) {
    return pem.error();
  }
  const auto key = KeyFromPem(*pem);
  if (!key) {
    return About(ErrorCode::kCorruptData, files.key, key.error().message);
  }
  if (!IsKeyOf(**key, identity)) {
    return About(ErrorCode::kCorruptData, files.key,
                 "is not the key of " + files.certificate.string());
  }
  if (!SubjectFits(identity, library)) {
    return About(ErrorCode::kInvalidArgument, files.certificate,
                 "has the subject \"" + SubjectOf(identity) +
                     "\", with which the two DDS libraries would not shake hands");
  }
  return Ok();
}

Status CheckPermissions(const CredentialFiles& files, const X509& identity, const X509& authority,
                        Time now) {
  const auto permissions = LoadSigned(files.permissions, authority);
  if (!permissions) {
    return permissions.error();
  }
  if (SubjectOf(*permissions) != SubjectOf(identity)) {
    return About(ErrorCode::kCorruptData, files.permissions,
                 "is for \"" + SubjectOf(*permissions) + "\", the identity is \"" +
                     SubjectOf(identity) + '"');
  }
  // Text of one format in UTC: compares as time does.
  const std::string until = ElementOf(*permissions, "not_after");
  if (IsoText(now) > until) {
    return Expired(files.permissions, until, now);
  }
  return Ok();
}

}  // namespace

Result<std::string> ReadFile(const fs::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (!file.is_open() || file.bad()) {
    return About(ErrorCode::kNotFound, path,
                 "cannot be read: " + std::error_code(errno, std::generic_category()).message());
  }
  return text;
}

CredentialFiles FilesOf(const fs::path& folder, const std::string& role, Library library) {
  std::error_code ignored;
  fs::path base = fs::absolute(folder, ignored);
  const fs::path own = base / role / NameOf(library);
  return {.authority = base / "ca.pem",
          .governance = base / "governance.p7s",
          .certificate = own.string() + ".pem",
          .key = own.string() + ".key",
          .permissions = own.string() + ".p7s"};
}

Result<CredentialFiles> CheckCredentials(const fs::path& folder, const std::string& role,
                                         Library library, Time now) {
  CredentialFiles files = FilesOf(folder, role, library);
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) {
    return About(ErrorCode::kNotFound, folder,
                 "is no folder: `limbcast security create` makes one");
  }
  if (!fs::is_directory(folder / role, ignored)) {
    return About(ErrorCode::kNotFound, folder,
                 "has no credentials of role \"" + role + "\": copy the folder of the role there");
  }
  const auto authority = LoadCertificate(files.authority);
  if (!authority) {
    return authority.error();
  }
  if (Status dates = CheckDates(files.authority, **authority, now); !dates) {
    return dates.error();
  }
  if (const auto governance = LoadSigned(files.governance, **authority); !governance) {
    return governance.error();
  }
  const auto identity = LoadCertificate(files.certificate);
  if (!identity) {
    return identity.error();
  }
  if (Status fits = CheckIdentity(files, **identity, **authority, library, now); !fits) {
    return fits.error();
  }
  if (Status fits = CheckPermissions(files, **identity, **authority, now); !fits) {
    return fits.error();
  }
  return files;
}

Result<Validity> ValidityOf(const fs::path& folder, const std::string& role, Library library) {
  const CredentialFiles files = FilesOf(folder, role, library);
  const auto identity = LoadCertificate(files.certificate);
  if (!identity) {
    return identity.error();
  }
  const auto validity = ValidityOf(**identity);
  return validity ? Result<Validity>(*validity)
                  : About(ErrorCode::kCorruptData, files.certificate, "has no readable dates");
}

}  // namespace limbcast::security
