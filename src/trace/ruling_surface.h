#pragma once
// Which closed surface rules at a point of a line, and so which medium is there.

#include <cstdint>

#include "trace/trace_settings.h"

namespace echocine {

// Where closed structures overlap the highest priority rules, among equals the later in the scene.
class RulingSurface {
 public:
  // The settings are kept by reference.
  explicit RulingSurface(const TraceSettings& settings) : settings_(settings) {}

  // Looks at all surfaces that hold the point.
  void find(const SurfaceSet& inside) {
    ruling_ = kNone;
    if (inside.none()) return;
    for (std::size_t s = 0; s < settings_.surfaces.size(); ++s)
      if (inside[s] && wins(s, ruling_)) ruling_ = s;
  }

  // Crosses surface s, a closed one: `inside` follows. Only a line that leaves the ruling surface
  // looks at all others.
  void cross(std::size_t s, bool entering, SurfaceSet& inside) {
    inside[s] = entering;
    if (entering) {
      if (wins(s, ruling_)) ruling_ = s;
    } else if (s == ruling_) {
      find(inside);
    }
  }

  MediumId medium() const {
    return ruling_ == kNone ? settings_.background : settings_.surfaces[ruling_].medium;
  }
  // From 1 in the scene's order; 0 in the background.
  std::uint16_t structure() const {
    return static_cast<std::uint16_t>(ruling_ == kNone ? 0 : ruling_ + 1);
  }

 private:
  static constexpr std::size_t kNone = kMaxSurfaces;

  bool wins(std::size_t surface, std::size_t over) const {
    if (over == kNone) return true;
    const int priority = settings_.surfaces[surface].priority,
              of_other = settings_.surfaces[over].priority;
    return priority > of_other || (priority == of_other && surface >= over);
  }

  const TraceSettings& settings_;
  std::size_t ruling_ = kNone;
};

}  // namespace echocine
