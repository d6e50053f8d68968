#pragma once
// Numbers of the command line: finite and within bounds. The library's own check accepts "nan", and
// rejects fractions if the bounds are whole numbers.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace echocine {

// Accepts low to high, ends included.
inline CLI::Validator within(double low, double high) {
  return CLI::Validator(
      [low, high](std::string& text) {
        double value = 0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high)
          return std::string();
        return fmt::format("{} is not accepted: a number from {} to {}", text, low, high);
      },
      "");
}

}  // namespace echocine
