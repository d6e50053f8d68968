#pragma once
// Reads a folder of `echocine render`: its cine, and the exact geometry from its manifest.

#include <filesystem>

#include "echo/echo_loop.h"

namespace echocine::echo {

bool isRenderFolder(const std::filesystem::path& path);  // does it contain a manifest.json?

// Is its cine.avi the one that a finished render wrote, by the digest in a sealed manifest? Throws
// SceneError for a damaged manifest.
bool holdsOwnCine(const std::filesystem::path& folder);

// Throws SceneError for an unfinished or damaged folder, one without a cine, and a linear probe.
EchoLoop readRenderFolder(const std::filesystem::path& folder);

}  // namespace echocine::echo
