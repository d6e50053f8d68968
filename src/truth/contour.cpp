#include "truth/contour.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace echocine {

namespace {

using EdgeKey = std::uint64_t;

EdgeKey edgeKey(std::uint32_t a, std::uint32_t b) {
  return (static_cast<EdgeKey>(std::min(a, b)) << 32) | std::max(a, b);
}

struct EdgeEnds {
  EdgeKey from, to;
};

// The edges that a triangle's cut runs between, in the cut's direction: those of the vertex alone
// on its side to the two others. By which vertices are above; a table, since no branch could be
// foretold.
struct Turn {
  std::uint8_t alone, from, to;
};
constexpr Turn kTurns[8] = {{},        {0, 1, 2}, {1, 2, 0}, {2, 1, 0},
                            {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {}};

EdgeEnds endsOf(const Triangle& t, const std::vector<Vec3f>& positions) {
  const unsigned above = (positions[t[0]].y >= 0 ? 1u : 0u) | (positions[t[1]].y >= 0 ? 2u : 0u) |
                         (positions[t[2]].y >= 0 ? 4u : 0u);
  const Turn turn = kTurns[above];
  return {edgeKey(t[turn.alone], t[turn.from]), edgeKey(t[turn.alone], t[turn.to])};
}

constexpr std::uint32_t kNone = static_cast<std::uint32_t>(-1);

// Which edge starts at a key; the first where several do. A table at most half full.
class EdgeStarts {
 public:
  void fill(std::span<const EdgeEnds> ends) {
    const std::size_t slots = std::bit_ceil(2 * ends.size() + 1);
    shift_ = 64 - std::countr_zero(slots);
    mask_ = slots - 1;
    slots_.assign(slots, {0, kNone});
    for (std::uint32_t i = 0; i < ends.size(); ++i) {
      Slot& slot = slots_[find(ends[i].from)];
      if (slot.edge == kNone) slot = {ends[i].from, i};
    }
  }
  // kNone where none starts.
  std::uint32_t at(EdgeKey key) const { return slots_[find(key)].edge; }

 private:
  struct Slot {
    EdgeKey key;
    std::uint32_t edge;
  };
  // The key's slot, or the empty one where it would stand.
  std::size_t find(EdgeKey key) const {
    std::size_t i = (key * 0x9E3779B97F4A7C15u) >> shift_;  // Fibonacci hashing
    while (slots_[i].edge != kNone && slots_[i].key != key) i = (i + 1) & mask_;
    return i;
  }

  int shift_ = 0;
  std::size_t mask_ = 0;
  std::vector<Slot> slots_;
};

// Chains the edges of one surface. Its triangles run the same way round, so an edge starts at most
// one edge and ends at most one: following an edge's end to the edge that starts there never
// branches. Memory is reused from surface to surface.
class Chainer {
 public:
  // `first`: the number of the first edge.
  void run(std::span<const ContourEdge> edges, std::size_t first, const SurfaceTopology& surface,
           const std::vector<Vec3f>& positions, std::vector<Contour>& out) {
    ends_.clear();
    for (const ContourEdge& edge : edges)
      ends_.push_back(endsOf(surface.triangles[edge.triangle], positions));
    starts_.fill(ends_);
    used_.assign(ends_.size(), 0);
    follows_.assign(ends_.size(), 0);
    next_.clear();
    for (const EdgeEnds& edge : ends_) {
      next_.push_back(starts_.at(edge.to));
      if (next_.back() != kNone) follows_[next_.back()] = 1;
    }
    const auto count = static_cast<std::uint32_t>(edges.size());
    for (std::uint32_t i = 0; i < count; ++i)
      if (follows_[i] == 0) follow(edges, first, i, out);  // open chains first, from their ends
    for (std::uint32_t i = 0; i < count; ++i)
      if (used_[i] == 0) follow(edges, first, i, out);
  }

 private:
  void follow(std::span<const ContourEdge> edges, std::size_t first, std::uint32_t begin,
              std::vector<Contour>& out) {
    chain_.clear();
    std::uint32_t next = begin;
    do {
      used_[next] = 1;
      chain_.push_back(next);
      next = next_[next];
    } while (next != kNone && used_[next] == 0);
    Contour contour{edges[begin].surface, next == begin, {}, {}};
    contour.edges.reserve(chain_.size());
    contour.points_m.reserve(chain_.size() + 1);
    contour.points_m.push_back(edges[begin].cut.from);
    for (const std::uint32_t i : chain_) {
      contour.edges.push_back(static_cast<std::uint32_t>(first + i));
      contour.points_m.push_back(edges[i].cut.to);
    }
    if (contour.closed) contour.points_m.pop_back();
    out.push_back(std::move(contour));
  }

  std::vector<EdgeEnds> ends_;
  EdgeStarts starts_;
  std::vector<std::uint8_t> used_;
  std::vector<std::uint8_t> follows_;  // an edge ends where this one starts
  std::vector<std::uint32_t> next_;    // the edge that starts where this one ends
  std::vector<std::uint32_t> chain_;
};

}  // namespace

std::vector<Contour> chainContours(std::span<const ContourEdge> edges,
                                   const std::vector<SurfaceTopology>& surfaces,
                                   const SurfaceFrame& frame) {
  std::vector<Contour> contours;
  thread_local Chainer chainer;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    const std::size_t surface = index(edges[begin].surface);
    for (end = begin; end < edges.size() && index(edges[end].surface) == surface;) ++end;
    chainer.run(edges.subspan(begin, end - begin), begin, surfaces[surface],
                frame.positions_m[surface], contours);
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
