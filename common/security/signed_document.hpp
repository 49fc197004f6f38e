#pragma once

#include <string>

#include "common/base/result.hpp"
#include "common/security/certificates.hpp"

namespace limbcast::security {

/// `text` signed by `authority` as S/MIME (RFC 5751, multipart/signed, text/plain): what `openssl
/// smime -sign -text` writes and DDS Security 1.1, 9.4.1.1 asks for.
[[nodiscard]] Result<std::string> Sign(const Identity& authority, const std::string& text);

/// The text of a signed document. Fails with kCorruptData: no S/MIME, changed after it was signed,
/// or signed by somebody else than `authority`.
[[nodiscard]] Result<std::string> ReadSigned(const std::string& document, const X509& authority);

}  // namespace limbcast::security
