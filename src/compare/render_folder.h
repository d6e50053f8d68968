#pragma once
// A folder that `echocine render` made: its cine, and the exact geometry from its manifest.

#include <filesystem>

#include "compare/loop.h"

namespace echocine::compare {

bool isRenderFolder(const std::filesystem::path& path);  // holds a manifest.json

// Throws SceneError: unfinished, damaged, without a cine, of a linear probe.
Loop readRenderFolder(const std::filesystem::path& folder);

}  // namespace echocine::compare
