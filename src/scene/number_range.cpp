#include "scene/number_range.h"

#include <fmt/format.h>

#include <cmath>

namespace echocine {

bool NumberRange::contains(double value) const {
  return std::isfinite(value) && (lo_open ? value > lo : value >= lo) &&
         (hi_open ? value < hi : value <= hi);
}

std::string NumberRange::text() const {
  const bool has_lo = std::isfinite(lo), has_hi = std::isfinite(hi);
  if (!has_lo && !has_hi) return "a finite number";
  if (!has_hi)
    return fmt::format("a number {} {}", lo_open ? "over" : "from", lo) + (lo_open ? "" : " up");
  if (!has_lo) return fmt::format("a number {} {}", hi_open ? "under" : "up to", hi);
  return fmt::format("a number {} {} {} {}", lo_open ? "over" : "from", lo,
                     hi_open ? "and under" : "to", hi);
}

}  // namespace echocine
