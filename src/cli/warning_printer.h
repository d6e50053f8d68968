#pragma once
// Warnings go to standard error, one line each. With --quiet only the warning about an empty
// picture is printed.

#include <fmt/format.h>

#include <functional>
#include <string>

#include "cli/one_line.h"
#include "cli/standard_error.h"
#include "plan/effect_plan.h"

namespace echocine {

inline std::function<void(const std::string&)> warningPrinter(bool quiet) {
  return [quiet](const std::string& warning) {
    if (quiet && !warning.starts_with(kNothingSeen)) return;
    writeError(fmt::format("echocine: warning: {}\n", oneLine(warning)));
  };
}

}  // namespace echocine
