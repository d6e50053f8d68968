#include "core/hash.h"

#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <new>
#include <vector>

#include "core/error.h"

namespace echocine {

struct DigestFree {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};
using DigestContext = std::unique_ptr<EVP_MD_CTX, DigestFree>;

namespace {

// Null where memory is short. In a context of its own: OpenSSL crashes where an allocation of its
// default context failed.
const EVP_MD* fetchSha256() {
  static OSSL_LIB_CTX* const library = OSSL_LIB_CTX_new();
  if (library == nullptr) return nullptr;
  const EVP_MD* const algorithm = EVP_MD_fetch(library, "SHA256", nullptr);
  const DigestContext first(EVP_MD_CTX_new());
  const bool works = algorithm != nullptr && first != nullptr &&
                     EVP_DigestInit_ex(first.get(), algorithm, nullptr) == 1;
  return works ? algorithm : nullptr;
}

// Fetched once per process. The fetch and the first digest leave an error queue in the calling
// thread; a worker thread that ends after OpenSSL's clean-up at exit would leak it, so it is freed
// here.
const EVP_MD* sha256Algorithm() {
  static const EVP_MD* const algorithm = [] {
    const EVP_MD* const fetched = fetchSha256();
    OPENSSL_thread_stop();
    return fetched;
  }();
  return algorithm;
}

}  // namespace

struct Sha256::State {
  DigestContext context{EVP_MD_CTX_new()};
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  if (state_->context == nullptr) throw std::bad_alloc();
  const EVP_MD* const algorithm = sha256Algorithm();
  if (algorithm == nullptr || EVP_DigestInit_ex(state_->context.get(), algorithm, nullptr) != 1)
    throw JobError("SHA-256: the installed OpenSSL does not have it, or is out of memory");
}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::update(std::span<const std::byte> bytes) {
  EVP_DigestUpdate(state_->context.get(), bytes.data(), bytes.size());
}

void Sha256::update(std::string_view text) {
  update(std::as_bytes(std::span(text)));
}

std::string Sha256::hex() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  EVP_DigestFinal_ex(state_->context.get(), digest.data(), &size);
  std::string text;
  for (unsigned i = 0; i < size; ++i) text += fmt::format("{:02x}", digest[i]);
  return text;
}

std::string sha256Hex(std::span<const std::byte> bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.hex();
}

std::string sha256HexOfFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file && errno == ENOMEM) throw std::bad_alloc();
  if (!file) throw JobError(fmt::format("{}: cannot be read", path.string()));
  Sha256 hash;
  std::vector<char> block(1 << 20);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    hash.update(std::string_view(block.data(), static_cast<std::size_t>(file.gcount())));
  }
  if (file.bad()) throw JobError(fmt::format("{}: reading failed", path.string()));
  return hash.hex();
}

}  // namespace echocine
