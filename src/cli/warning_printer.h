#pragma once
// Warnings go to standard error, one line each, unless the run is to be quiet.

#include <fmt/format.h>

#include <cstdio>
#include <functional>
#include <string>

namespace echocine {

inline std::function<void(const std::string&)> warningPrinter(bool quiet) {
  if (quiet) return [](const std::string&) {};
  return [](const std::string& warning) { fmt::print(stderr, "echocine: warning: {}\n", warning); };
}

}  // namespace echocine
