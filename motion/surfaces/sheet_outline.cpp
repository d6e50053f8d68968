#include "motion/surfaces/sheet_outline.h"

#include <algorithm>

#include "motion/mesh/edge_sides.h"

namespace echocine {

SheetOutline outlineOf(const std::vector<Triangle>& faces) {
  SheetOutline outline;
  bool is_oriented = true;
  forEachEdge(sortedSides(faces), [&](std::span<const Side> edge) {
    if (edge.size() == 1)
      outline.emplace_back(sideStart(faces, edge[0].side), sideEnd(faces, edge[0].side));
    else if (edge.size() > 2 || edge[0].descending == edge[1].descending)
      is_oriented = false;
  });
  if (!is_oriented) return {};
  std::sort(outline.begin(), outline.end());
  return outline;
}

}  // namespace echocine
