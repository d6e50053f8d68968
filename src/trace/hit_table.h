#pragma once
// The hits of a frame's lines, indexed by line, surface and direction of crossing.

#include <span>
#include <vector>

#include "trace/line_trace.h"

namespace echocine {

class HitTable {
 public:
  // Precondition: `lines` outlive the table.
  HitTable(std::span<const LineTrace> lines, std::size_t surfaces);

  // The hit nearest to a path length; none if the line does not cross the surface in that
  // direction. path_m: a function that returns it; called only if there are several hits.
  template <typename PathLength>
  const InterfaceHit* nearest(std::size_t line, SurfaceId surface, bool entering,
                              PathLength&& path_m) const {
    const std::uint32_t at = heads_[keyOf(line, surface, entering)];
    if (at == 0) return nullptr;
    const Link& link = links_[at - 1];
    return link.next == 0 ? link.hit : nearestOf(link, path_m());
  }

 private:
  struct Link {
    const InterfaceHit* hit;
    std::uint32_t next;  // 1 + position in links_, or 0
  };

  std::size_t keyOf(std::size_t line, SurfaceId surface, bool entering) const {
    return 2 * (line * surfaces_ + index(surface)) + (entering ? 1 : 0);
  }
  const InterfaceHit* nearestOf(const Link& first, double path_m) const;

  std::size_t surfaces_;
  std::vector<Link> links_;
  std::vector<std::uint32_t> heads_;  // by keyOf(): as Link::next
};

}  // namespace echocine
