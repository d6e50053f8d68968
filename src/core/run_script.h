#pragma once
// Runs another program and waits for it.

#include <filesystem>

namespace echocine {

// Runs a shell script with this program's output streams. True if it ended with 0.
bool runScript(const std::filesystem::path& script);

}  // namespace echocine
