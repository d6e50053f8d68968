#pragma once
// The digest that an EXR of ours holds of itself: of all its bytes, its own digits read as zeros.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace echocine {

inline constexpr const char* kExrDigestName = "echocine:digest";

// What the attribute holds until the file's bytes are known.
std::string emptyExrDigest();

// Puts the digest into the attribute's place. Precondition: the attribute is there, empty.
void sealExr(std::span<std::byte> file);

// Whether the file holds its own digest, unharmed. False for one that cannot be read.
bool isSealedExr(const std::filesystem::path& path);

}  // namespace echocine
