#pragma once
// The digest inside our EXR files: of all bytes, with the digest's own digits read as zeros.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace echocine {

inline constexpr const char* kExrDigestName = "echocine:digest";

// The attribute's value until the digest is computed.
std::string emptyExrDigest();

// Writes the digest into the attribute. Precondition: the attribute exists, empty.
void sealExr(std::span<std::byte> file);

// Does the file match its own digest? False for an unreadable file.
bool isSealedExr(const std::filesystem::path& path);

}  // namespace echocine
