#pragma once
// Reads a folder of `echocine render`: its cine, and the exact geometry from its manifest.

#include <filesystem>

#include "echo/echo_loop.h"

namespace echocine::echo {

bool isRenderFolder(const std::filesystem::path& path);  // does it contain a manifest.json?

// Throws SceneError for an unfinished or damaged folder, one without a cine, and a linear probe.
EchoLoop readRenderFolder(const std::filesystem::path& folder);

}  // namespace echocine::echo
