#include "geometry/line_states.h"

#include <algorithm>

namespace echocine {

bool nearer(const Crossing& a, const Crossing& b) {
  if (a.distance_m != b.distance_m) return a.distance_m < b.distance_m;
  if (a.surface != b.surface) return a.surface < b.surface;
  return a.triangle < b.triangle;
}

void balances(const std::vector<Crossing>& crossings, std::vector<int>& out) {
  std::fill(out.begin(), out.end(), 0);
  for (const Crossing& c : crossings) out[index(c.surface)] += c.entering ? 1 : -1;
}

void keepChanges(std::vector<Crossing>& crossings, std::vector<int>& depth,
                 const InsideSet& membranes, const InsideSet& clamped) {
  std::erase_if(crossings, [&](const Crossing& c) {
    const std::size_t s = index(c.surface);
    if (membranes[s]) return false;
    const int before = depth[s];
    depth[s] += c.entering ? 1 : -1;
    if (clamped[s]) depth[s] = std::clamp(depth[s], 0, 1);
    return (before > 0) == (depth[s] > 0);
  });
}

}  // namespace echocine
