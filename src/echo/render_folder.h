#pragma once
// A folder that `echocine render` made: its cine, and the exact geometry from its manifest.

#include <filesystem>

#include "echo/echo_loop.h"

namespace echocine::echo {

bool isRenderFolder(const std::filesystem::path& path);  // holds a manifest.json

// Throws SceneError: unfinished, damaged, without a cine, of a linear probe.
EchoLoop readRenderFolder(const std::filesystem::path& folder);

}  // namespace echocine::echo
