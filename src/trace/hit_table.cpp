#include "trace/hit_table.h"

#include <cmath>

namespace echocine {

HitTable::HitTable(std::span<const LineTrace> lines, std::size_t surfaces)
    : surfaces_(surfaces), heads_(lines.size() * 2 * surfaces) {
  std::size_t count = 0;
  for (const LineTrace& line : lines) count += line.hits.size();
  links_.reserve(count);
  for (std::size_t line = 0; line < lines.size(); ++line)
    for (std::size_t k = lines[line].hits.size(); k-- > 0;) {
      const InterfaceHit& hit = lines[line].hits[k];
      std::uint32_t& head = heads_[keyOf(line, hit.surface, hit.entering)];
      links_.push_back({&hit, head});
      head = static_cast<std::uint32_t>(links_.size());
    }
}

const InterfaceHit* HitTable::nearestOf(const Link& first, double path_m) const {
  const InterfaceHit* best = first.hit;
  for (std::uint32_t at = first.next; at != 0; at = links_[at - 1].next) {
    const InterfaceHit* hit = links_[at - 1].hit;
    if (std::abs(hit->path_m - path_m) < std::abs(best->path_m - path_m)) best = hit;
  }
  return best;
}

}  // namespace echocine
