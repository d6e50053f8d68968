#pragma once
// Arguments of `echocine dataset` with a form of their own. Both throw SceneError.

#include <string>
#include <utility>

namespace echocine {

// "3/7": the third of seven parts.
std::pair<int, int> parseTask(const std::string& text);

// "loop.avi=0.31": a loop, and the side of its square pixels, mm.
std::pair<std::string, double> parseRealLoop(const std::string& text);

}  // namespace echocine
