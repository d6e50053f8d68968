#pragma once
// Reference to the documents at the end of help texts.

namespace echocine {

inline constexpr const char* kDocuments =
    "Documents: man echocine; README.md of the source or in share/doc/echocine; every scene key "
    "with "
    "its default: examples/every_key/scene.toml there";

}  // namespace echocine
