#pragma once
// Bytes as text (RFC 4648, with padding).

#include <cstddef>
#include <span>
#include <string>

namespace echocine {

// Precondition: under 1 GiB.
std::string base64(std::span<const std::byte> bytes);

}  // namespace echocine
