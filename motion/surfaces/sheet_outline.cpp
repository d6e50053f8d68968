#include "motion/surfaces/sheet_outline.h"

#include <map>

namespace echocine {

SheetOutline outlineOf(const std::vector<Triangle>& faces) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const Triangle& t : faces)
    for (std::size_t k = 0; k < 3; ++k) ++runs[{t[k], t[(k + 1) % 3]}];
  SheetOutline outline;
  for (const auto& [edge, count] : runs) {
    if (count > 1) return {};
    if (!runs.contains({edge.second, edge.first})) outline.push_back(edge);
  }
  return outline;
}

}  // namespace echocine
