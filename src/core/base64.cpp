#include "core/base64.h"

#include <openssl/evp.h>

#include "core/check.h"

namespace echocine {

std::string base64(std::span<const std::byte> bytes) {
  CHECK_LT(bytes.size(), std::size_t{1} << 30);
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // OpenSSL ends it with a NUL
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                  reinterpret_cast<const unsigned char*>(bytes.data()),
                  static_cast<int>(bytes.size()));
  text.pop_back();
  return text;
}

}  // namespace echocine
