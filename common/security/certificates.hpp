#pragma once

#include <openssl/types.h>

#include <memory>
#include <optional>
#include <string>

#include "common/base/result.hpp"
#include "common/security/documents.hpp"

namespace limbcast::security {

struct FreeKey {
  void operator()(EVP_PKEY* key) const;
};
struct FreeCertificate {
  void operator()(X509* certificate) const;
};
using Key = std::unique_ptr<EVP_PKEY, FreeKey>;
using Certificate = std::unique_ptr<X509, FreeCertificate>;

/// A certificate with its private key.
struct Identity {
  Key key;
  Certificate certificate;
};

/// A self-signed certificate that may sign others. `name` becomes its common name.
[[nodiscard]] Result<Identity> MakeAuthority(const std::string& name, const Validity& validity);

/// The DDS library that an identity is for; decides its subject name, see README.
enum class Library : std::uint8_t { kCyclone, kFast };
/// "cyclone" | "fast".
[[nodiscard]] std::string NameOf(Library library);

/// An identity signed by `authority`: its common name is "<name>-<number>" with the first number
/// whose subject fits the library.
[[nodiscard]] Result<Identity> MakeIdentity(const Identity& authority, const std::string& name,
                                            Library library, const Validity& validity);

/// Whether a participant with that certificate starts the handshakes that it has to.
[[nodiscard]] bool SubjectFits(const X509& certificate, Library library);
/// In the order of RFC 2253: "CN=gateway-12,O=Limbcast".
[[nodiscard]] std::string SubjectOf(const X509& certificate);
/// When it is valid; nothing when its dates cannot be read.
[[nodiscard]] std::optional<Validity> ValidityOf(const X509& certificate);
/// Whether `authority` has signed it (dates are not looked at).
[[nodiscard]] bool IsSignedBy(const X509& certificate, const X509& authority);
[[nodiscard]] bool IsKeyOf(const EVP_PKEY& key, const X509& certificate);

[[nodiscard]] std::string ToPem(const X509& certificate);
[[nodiscard]] std::string ToPem(const EVP_PKEY& key);
/// Fail with kCorruptData; the caller knows the name of the file.
[[nodiscard]] Result<Certificate> CertificateFromPem(const std::string& pem);
[[nodiscard]] Result<Key> KeyFromPem(const std::string& pem);

/// What OpenSSL says went wrong last in this thread; empties its queue.
[[nodiscard]] std::string OpenSslReason();

}  // namespace limbcast::security
