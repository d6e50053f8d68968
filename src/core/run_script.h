#pragma once
// Another program's work, waited for.

#include <filesystem>

namespace echocine {

// Runs a script of sh, which writes where this program writes. Whether it ended with 0.
bool runScript(const std::filesystem::path& script);

}  // namespace echocine
