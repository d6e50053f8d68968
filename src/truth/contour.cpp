#include "truth/contour.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "core/hash_random.h"

namespace echocine {

namespace {

using EdgeKey = std::uint64_t;

EdgeKey edgeKey(std::uint32_t a, std::uint32_t b) {
  return (static_cast<EdgeKey>(std::min(a, b)) << 32) | std::max(a, b);
}

struct EdgeEnds {
  EdgeKey from, to;
};

// The edges that a triangle's cut runs between, in the cut's direction.
EdgeEnds endsOf(const Triangle& t, const std::vector<Vec3f>& positions) {
  const bool above[3] = {positions[t[0]].y >= 0, positions[t[1]].y >= 0, positions[t[2]].y >= 0};
  const std::size_t k = above[1] == above[2] ? 0 : above[0] == above[2] ? 1 : 2;
  const EdgeKey first = edgeKey(t[k], t[(k + 1) % 3]), second = edgeKey(t[k], t[(k + 2) % 3]);
  return above[k] ? EdgeEnds{first, second} : EdgeEnds{second, first};
}

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Which edge starts at a key; the first where several do. A table at most half full.
class EdgeStarts {
 public:
  explicit EdgeStarts(const std::vector<EdgeEnds>& ends)
      : mask_(std::bit_ceil(2 * ends.size() + 1) - 1), slots_(mask_ + 1, {0, kNone}) {
    for (std::size_t i = 0; i < ends.size(); ++i) {
      Slot& slot = slots_[find(ends[i].from)];
      if (slot.edge == kNone) slot = {ends[i].from, i};
    }
  }
  // kNone where none starts.
  std::size_t at(EdgeKey key) const { return slots_[find(key)].edge; }

 private:
  struct Slot {
    EdgeKey key;
    std::size_t edge;
  };
  // The key's slot, or the empty one where it would stand.
  std::size_t find(EdgeKey key) const {
    std::size_t i = mixBits(key) & mask_;
    while (slots_[i].edge != kNone && slots_[i].key != key) i = (i + 1) & mask_;
    return i;
  }

  std::size_t mask_;
  std::vector<Slot> slots_;
};

// Chains the edges of one surface. Its triangles run the same way round, so an edge starts at most
// one edge and ends at most one: following an edge's end to the edge that starts there never
// branches.
class Chainer {
 public:
  // `first`: the number of the first edge.
  Chainer(std::span<const ContourEdge> edges, std::size_t first, std::vector<EdgeEnds> ends)
      : edges_(edges),
        first_(first),
        ends_(std::move(ends)),
        used_(ends_.size(), false),
        follows_(ends_.size(), false) {
    const EdgeStarts starts(ends_);
    for (const EdgeEnds& edge : ends_) {
      next_.push_back(starts.at(edge.to));
      if (next_.back() != kNone) follows_[next_.back()] = true;
    }
  }

  void run(std::vector<Contour>& out) {
    for (std::size_t i = 0; i < ends_.size(); ++i)
      if (!follows_[i]) follow(i, out);  // open chains first, from their ends
    for (std::size_t i = 0; i < ends_.size(); ++i)
      if (!used_[i]) follow(i, out);
  }

 private:
  void follow(std::size_t first, std::vector<Contour>& out) {
    Contour contour{edges_[first].surface, false, {edges_[first].cut.from}, {}};
    for (std::size_t i = first;;) {
      used_[i] = true;
      contour.edges.push_back(static_cast<std::uint32_t>(first_ + i));
      const std::size_t next = next_[i];
      contour.closed = next == first;
      if (contour.closed) break;
      contour.points_m.push_back(edges_[i].cut.to);
      if (next == kNone || used_[next]) break;
      i = next;
    }
    out.push_back(std::move(contour));
  }

  std::span<const ContourEdge> edges_;
  std::size_t first_;
  std::vector<EdgeEnds> ends_;
  std::vector<bool> used_;
  std::vector<bool> follows_;      // an edge ends where this one starts
  std::vector<std::size_t> next_;  // the edge that starts where this one ends
};

}  // namespace

std::vector<Contour> chainContours(std::span<const ContourEdge> edges,
                                   const std::vector<SurfaceTopology>& surfaces,
                                   const SurfaceFrame& frame) {
  std::vector<Contour> contours;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    const std::size_t surface = index(edges[begin].surface);
    std::vector<EdgeEnds> ends;
    for (end = begin; end < edges.size() && index(edges[end].surface) == surface; ++end)
      ends.push_back(
          endsOf(surfaces[surface].triangles[edges[end].triangle], frame.positions_m[surface]));
    Chainer(edges.subspan(begin, end - begin), begin, std::move(ends)).run(contours);
  }
  return contours;
}

std::vector<Contour> contoursAt(const MeshMotion& motion, const Probe& probe, double phase) {
  SurfaceFrame frame;
  motion.frameAt(phase - std::floor(phase), frame);
  PlaneSlice slice(motion.surfaces(), probe);
  slice.cut(frame);
  return chainContours(slice.edges(), motion.surfaces(), frame);
}

}  // namespace echocine
