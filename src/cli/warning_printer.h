#pragma once
// Warnings go to standard error, one line each, unless the run is to be quiet.

#include <fmt/format.h>

#include <functional>
#include <string>

#include "cli/one_line.h"
#include "cli/standard_error.h"

namespace echocine {

inline std::function<void(const std::string&)> warningPrinter(bool quiet) {
  if (quiet) return [](const std::string&) {};
  return [](const std::string& warning) {
    writeError(fmt::format("echocine: warning: {}\n", oneLine(warning)));
  };
}

}  // namespace echocine
