#pragma once
// The numbers that a key accepts.

#include <limits>
#include <string>

namespace echocine {

// Accepted numbers: lo..hi; an absent end is open.
struct NumberRange {
  double lo = -std::numeric_limits<double>::infinity();
  double hi = std::numeric_limits<double>::infinity();
  bool lo_open = false, hi_open = false;

  bool contains(double value) const;
  std::string text() const;  // "a number from 1 to 2"
};

}  // namespace echocine
