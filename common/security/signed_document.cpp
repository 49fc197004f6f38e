#include "common/security/signed_document.hpp"

#include <openssl/err.h>
#include <openssl/pkcs7.h>
#include <openssl/x509.h>

#include <memory>

#include "common/security/memory_bio.hpp"

namespace limbcast::security {
namespace {

struct FreePkcs7 {
  void operator()(PKCS7* signature) const { PKCS7_free(signature); }
};
using Signature = std::unique_ptr<PKCS7, FreePkcs7>;
struct FreeStack {
  void operator()(STACK_OF(X509) * stack) const { sk_X509_free(stack); }  // not what is in it
};

}  // namespace

Result<std::string> Sign(const Identity& authority, const std::string& text) {
  constexpr int kHow = PKCS7_DETACHED | PKCS7_TEXT | PKCS7_STREAM;
  const Bio in = Reading(text);
  const Signature signature(
      PKCS7_sign(authority.certificate.get(), authority.key.get(), nullptr, in.get(), kHow));
  const Bio out(BIO_new(BIO_s_mem()));
  if (signature == nullptr || SMIME_write_PKCS7(out.get(), signature.get(), in.get(), kHow) != 1) {
    return Error{ErrorCode::kUnavailable, "OpenSSL cannot sign a document: " + OpenSslReason()};
  }
  return TextOf(out.get());
}

Result<std::string> ReadSigned(const std::string& document, const X509& authority) {
  const Bio in = Reading(document);
  BIO* raw_content = nullptr;
  const Signature signature(SMIME_read_PKCS7(in.get(), &raw_content));
  const Bio content(raw_content);
  if (signature == nullptr || content == nullptr) {
    return Error{ErrorCode::kCorruptData, "is no signed document (" + OpenSslReason() + ")"};
  }
  // The signer must be this certificate and no other: what the document carries does not count, and
  // its validity is looked at elsewhere, so no chain is built.
  const std::unique_ptr<STACK_OF(X509), FreeStack> signers(sk_X509_new_null());
  sk_X509_push(signers.get(), const_cast<X509*>(&authority));  // NOLINT: not changed, see FreeStack
  const Bio out(BIO_new(BIO_s_mem()));
  constexpr int kHow = PKCS7_TEXT | PKCS7_NOVERIFY | PKCS7_NOINTERN;
  if (PKCS7_verify(signature.get(), signers.get(), nullptr, content.get(), out.get(), kHow) != 1) {
    return Error{ErrorCode::kCorruptData,
                 "was changed, or signed by another authority (" + OpenSslReason() + ")"};
  }
  return TextOf(out.get());
}

}  // namespace limbcast::security
