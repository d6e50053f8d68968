#pragma once
// Where help ends and documents begin.

namespace echocine {

inline constexpr const char* kDocuments =
    "Documents: README.md of the source; every scene key with its default: "
    "examples/every_key/scene.toml";

}  // namespace echocine
