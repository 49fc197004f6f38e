#pragma once

#include <openssl/bio.h>

#include <memory>
#include <string>

/// OpenSSL's buffers in memory. Only this room's sources include it: OpenSSL stays inside.
namespace limbcast::security {

struct FreeBio {
  void operator()(BIO* bio) const { BIO_free_all(bio); }
};
using Bio = std::unique_ptr<BIO, FreeBio>;

/// To read `text`, which outlives it.
[[nodiscard]] inline Bio Reading(const std::string& text) {
  return Bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
}

/// What was written into it.
[[nodiscard]] inline std::string TextOf(BIO* bio) {
  char* data = nullptr;
  const long length = BIO_get_mem_data(bio, &data);
  return length > 0 ? std::string(data, static_cast<std::size_t>(length)) : std::string();
}

}  // namespace limbcast::security
