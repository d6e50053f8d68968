#include "geometry/line_states.h"

#include <algorithm>

namespace echocine {

// A hierarchy's order is mostly that of distance, and has a triangle seldom twice.
void putInOrder(std::vector<Crossing>& crossings) {
  const auto begin = crossings.begin(), end = crossings.end();
  const auto misplaced = [](const Crossing& a, const Crossing& b) { return !nearer(a, b); };
  if (std::adjacent_find(begin, end, misplaced) == end) return;
  std::sort(begin, end, nearer);
  const auto same = [](const Crossing& a, const Crossing& b) {
    return a.surface == b.surface && a.triangle == b.triangle;
  };
  crossings.erase(std::unique(begin, end, same), end);
}

void balances(const std::vector<Crossing>& crossings, std::vector<int>& out) {
  std::fill(out.begin(), out.end(), 0);
  for (const Crossing& c : crossings) out[index(c.surface)] += c.entering ? 1 : -1;
}

bool statesAlternate(const std::vector<Crossing>& crossings, InsideSet inside,
                     const InsideSet& membranes) {
  for (const Crossing& c : crossings) {
    const std::size_t s = index(c.surface);
    if (membranes[s]) continue;
    if (inside[s] == c.entering) return false;
    inside[s] = c.entering;
  }
  return inside.none();
}

namespace {

// A line ends outside every closed surface, so an entry that no later exit answers is rounding: a
// start on a vertex may lie within a facet by its last bit, and the facet beside it behind the
// start.
void dropUnansweredEntries(std::vector<Crossing>& crossings, std::size_t surface) {
  int exits = 0;
  for (std::size_t i = crossings.size(); i-- > 0;) {
    if (index(crossings[i].surface) != surface) continue;
    if (!crossings[i].entering)
      ++exits;
    else if (exits > 0)
      --exits;
    else
      crossings.erase(crossings.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

void keepChanges(std::vector<Crossing>& crossings, std::vector<int>& depth,
                 const InsideSet& membranes, const InsideSet& clamped) {
  for (std::size_t s = 0; clamped.any() && s < depth.size(); ++s)
    if (clamped[s]) dropUnansweredEntries(crossings, s);
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
