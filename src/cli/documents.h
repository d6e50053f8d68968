#pragma once
// Reference to the documents at the end of help texts.

namespace echocine {

inline constexpr const char* kDocuments =
    "Documents: man echocine; README.md; examples/every_key/scene.toml (every scene key with its "
    "default). The files are in the source folder or in share/doc/echocine.";

}  // namespace echocine
