#include "common/security/certificates.hpp"

#include <openssl/asn1.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <array>
#include <chrono>
#include <ctime>

#include "common/security/memory_bio.hpp"

namespace limbcast::security {
namespace {

constexpr unsigned kLowestOfFast = 0xF0;
constexpr unsigned kLimitOfCyclone = 0x10;
constexpr int kMaxTries = 10'000;  // one in 16 fits

struct FreeName {
  void operator()(X509_NAME* name) const { X509_NAME_free(name); }
};
using Name = std::unique_ptr<X509_NAME, FreeName>;

Error Failed(const char* what) {
  return Error{ErrorCode::kUnavailable,
               std::string("OpenSSL cannot ") + what + ": " + OpenSslReason()};
}

// OpenSSL's interfaces are older than const in some places; none of these change their argument.
X509* Mutable(const X509& certificate) {
  return const_cast<X509*>(&certificate);  // NOLINT: see above
}
EVP_PKEY* Mutable(const EVP_PKEY& key) {
  return const_cast<EVP_PKEY*>(&key);  // NOLINT: see above
}

Name MakeName(const std::string& common_name) {
  Name name(X509_NAME_new());
  const auto add = [&](const char* field, const std::string& value) {
    return X509_NAME_add_entry_by_txt(
               name.get(), field, MBSTRING_UTF8,
               reinterpret_cast<const unsigned char*>(value.c_str()),  // NOLINT: bytes of UTF-8
               -1, -1, 0) == 1;
  };
  const bool added = name != nullptr && add("O", "Limbcast") && add("CN", common_name);
  return added ? std::move(name) : nullptr;
}

bool Fits(const X509_NAME* name, Library library) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> hash{};
  if (X509_NAME_digest(name, EVP_sha256(), hash.data(), nullptr) != 1) {
    return false;
  }
  return library == Library::kFast ? hash[0] >= kLowestOfFast : hash[0] < kLimitOfCyclone;
}

Time TimeOf(const std::tm& utc) {
  std::tm copy = utc;
  return Time(std::chrono::duration_cast<Duration>(std::chrono::seconds(timegm(&copy))));
}

bool SetTime(ASN1_TIME* target, Time time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch());
  return ASN1_TIME_set(target, seconds.count()) != nullptr;
}

bool AddExtension(X509& certificate, X509& issuer, int id, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, &issuer, &certificate, nullptr, nullptr, 0);
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, id, value);
  const bool added = extension != nullptr && X509_add_ext(&certificate, extension, -1) == 1;
  X509_EXTENSION_free(extension);
  return added;
}

// A key and a certificate of `name`, not signed yet.
Result<Identity> MakeUnsigned(const X509_NAME* name, const Validity& validity) {
  // What EVP_EC_gen expands to, without its cast from const.
  EVP_PKEY* key = EVP_PKEY_Q_keygen(nullptr, nullptr, "EC", "prime256v1");  // NOLINT(*-vararg)
  Identity identity{Key(key), Certificate(X509_new())};
  if (identity.key == nullptr || identity.certificate == nullptr) {
    return Failed("make a key");
  }
  X509* certificate = identity.certificate.get();
  std::uint64_t serial = 0;
  const bool ready =
      RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof serial) == 1 &&  // NOLINT: bytes
      X509_set_version(certificate, X509_VERSION_3) == 1 &&
      ASN1_INTEGER_set_uint64(X509_get_serialNumber(certificate), serial >> 1) == 1 &&
      SetTime(X509_getm_notBefore(certificate), validity.from) &&
      SetTime(X509_getm_notAfter(certificate), validity.until) &&
      X509_set_subject_name(certificate, name) == 1 &&
      X509_set_pubkey(certificate, identity.key.get()) == 1;
  if (!ready) {
    return Failed("make a certificate");
  }
  return identity;
}

}  // namespace

void FreeKey::operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
void FreeCertificate::operator()(X509* certificate) const { X509_free(certificate); }

std::string OpenSslReason() {
  std::string reason;
  while (const unsigned long code = ERR_get_error()) {
    const char* text = ERR_reason_error_string(code);
    reason = text != nullptr ? text : "error " + std::to_string(code);
  }
  return reason.empty() ? "no reason given" : reason;
}

std::string NameOf(Library library) { return library == Library::kFast ? "fast" : "cyclone"; }

Result<Identity> MakeAuthority(const std::string& name, const Validity& validity) {
  const Name subject = MakeName(name);
  if (subject == nullptr) {
    return Failed("make a name");
  }
  auto made = MakeUnsigned(subject.get(), validity);
  if (!made) {
    return made;
  }
  X509& certificate = *made->certificate;
  const bool done =
      X509_set_issuer_name(&certificate, subject.get()) == 1 &&
      AddExtension(certificate, certificate, NID_basic_constraints, "critical,CA:TRUE") &&
      AddExtension(certificate, certificate, NID_subject_key_identifier, "hash") &&
      X509_sign(&certificate, made->key.get(), EVP_sha256()) > 0;
  if (!done) {
    return Failed("sign the authority");
  }
  return made;
}

Result<Identity> MakeIdentity(const Identity& authority, const std::string& name, Library library,
                              const Validity& validity) {
  Name subject;
  for (int number = 0; number < kMaxTries && subject == nullptr; ++number) {
    Name candidate = MakeName(name + "-" + std::to_string(number));
    if (candidate == nullptr) {
      return Failed("make a name");
    }
    if (Fits(candidate.get(), library)) {
      subject = std::move(candidate);
    }
  }
  if (subject == nullptr) {
    return Error{ErrorCode::kUnavailable, "no subject name for " + name + " fits"};
  }
  auto made = MakeUnsigned(subject.get(), validity);
  if (!made) {
    return made;
  }
  X509& certificate = *made->certificate;
  const X509_NAME* issuer = X509_get_subject_name(authority.certificate.get());
  if (X509_set_issuer_name(&certificate, issuer) != 1 ||
      X509_sign(&certificate, authority.key.get(), EVP_sha256()) <= 0) {
    return Failed("sign an identity");
  }
  return made;
}

bool SubjectFits(const X509& certificate, Library library) {
  return Fits(X509_get_subject_name(&certificate), library);
}

std::string SubjectOf(const X509& certificate) {
  const Bio bio(BIO_new(BIO_s_mem()));
  X509_NAME_print_ex(bio.get(), X509_get_subject_name(&certificate), 0,
                     XN_FLAG_RFC2253 & ~ASN1_STRFLGS_ESC_MSB);
  return TextOf(bio.get());
}

std::optional<Validity> ValidityOf(const X509& certificate) {
  std::tm from{};
  std::tm until{};
  if (ASN1_TIME_to_tm(X509_get0_notBefore(&certificate), &from) != 1 ||
      ASN1_TIME_to_tm(X509_get0_notAfter(&certificate), &until) != 1) {
    return std::nullopt;
  }
  return Validity{TimeOf(from), TimeOf(until)};
}

bool IsSignedBy(const X509& certificate, const X509& authority) {
  EVP_PKEY* key = X509_get0_pubkey(&authority);
  const bool is_signed =
      key != nullptr && X509_verify(Mutable(certificate), key) == 1 &&
      X509_NAME_cmp(X509_get_issuer_name(&certificate), X509_get_subject_name(&authority)) == 0;
  ERR_clear_error();
  return is_signed;
}

bool IsKeyOf(const EVP_PKEY& key, const X509& certificate) {
  const bool fits = X509_check_private_key(&certificate, &key) == 1;
  ERR_clear_error();
  return fits;
}

std::string ToPem(const X509& certificate) {
  const Bio bio(BIO_new(BIO_s_mem()));
  PEM_write_bio_X509(bio.get(), Mutable(certificate));
  return TextOf(bio.get());
}

std::string ToPem(const EVP_PKEY& key) {
  const Bio bio(BIO_new(BIO_s_mem()));
  PEM_write_bio_PrivateKey(bio.get(), Mutable(key), nullptr, nullptr, 0, nullptr, nullptr);
  return TextOf(bio.get());
}

Result<Certificate> CertificateFromPem(const std::string& pem) {
  Certificate certificate(PEM_read_bio_X509(Reading(pem).get(), nullptr, nullptr, nullptr));
  if (certificate == nullptr) {
    return Error{ErrorCode::kCorruptData, "is no certificate (" + OpenSslReason() + ")"};
  }
  return certificate;
}

Result<Key> KeyFromPem(const std::string& pem) {
  // A passphrase would be asked for on the terminal: an empty answer instead.
  std::string none;
  Key key(PEM_read_bio_PrivateKey(Reading(pem).get(), nullptr, nullptr, none.data()));
  if (key == nullptr) {
    return Error{ErrorCode::kCorruptData,
                 "is no private key without passphrase (" + OpenSslReason() + ")"};
  }
  return key;
}

}  // namespace limbcast::security
