#pragma once
// Manifests whose last key is the SHA-256 of the bytes before it, so that no flipped bit is
// believed.

#include <string>
#include <string_view>

namespace echocine {

// The text of a JSON object with `"manifest_sha256": "<64 digits>"` added as its last key.
// Precondition: it has a key, and ends with "\n}", as nlohmann::json::dump(1) writes it.
std::string sealed(std::string object);

// True if sealed() made the text.
bool isSealed(std::string_view text);

}  // namespace echocine
