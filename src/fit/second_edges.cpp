#include "fit/second_edges.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace echocine::fit {

namespace {

// Distances before a boundary, along its normal: an edge counts fully between `from_m` and `to_m`,
// not at all up to `none_m` and from `beyond_m` on, and linearly between. Our choice.
struct Reach {
  float none_m, from_m, to_m, beyond_m;

  float share(float before_m) const {
    return std::clamp((before_m - none_m) / (from_m - none_m), 0.0f, 1.0f) *
           std::clamp((beyond_m - before_m) / (beyond_m - to_m), 0.0f, 1.0f);
  }
};
// Nearer boundaries merge with the edge; farther ones are outside the profile.
constexpr Reach kBoundary{2e-3f, 3.5e-3f, 7e-3f, 9e-3f};
// A leaflet is 2 to 3 mm thick, so its side towards the blood is in the profile from farther away,
// and it never merges with the wall: it moves the visible edge.
constexpr Reach kSheet{-1.5e-3f, 0, 8.5e-3f, 10.5e-3f};
// The fibrous ring at a hinge and the thick free edge: a disc of 3 mm, the radius of the ring.
constexpr float kDisc_m = 3e-3f, kBesideDisc_m = 4.5e-3f;
// Across the normal: a hat as wide as the pieces' spacing, so that a boundary counts once.
constexpr auto kAcross_m = static_cast<float>(kBoundaryPiece_m);

// Edges in square cells as wide as the longest reach.
class EdgeGrid {
 public:
  struct Edge {
    float x, z, nx, nz;
    bool sheet, end;
  };

  explicit EdgeGrid(std::vector<Edge> edges) : edges_(std::move(edges)) {
    for (const Edge& e : edges_) {
      low_x_ = std::min(low_x_, cellOf(e.x)), high_x_ = std::max(high_x_, cellOf(e.x));
      low_z_ = std::min(low_z_, cellOf(e.z)), high_z_ = std::max(high_z_, cellOf(e.z));
    }
    if (edges_.empty()) return;
    starts_.assign(static_cast<std::size_t>((high_x_ - low_x_ + 1) * (high_z_ - low_z_ + 1)) + 1,
                   0);
    std::stable_sort(edges_.begin(), edges_.end(),
                     [&](const Edge& a, const Edge& b) { return at(a) < at(b); });
    for (const Edge& e : edges_) ++starts_[at(e) + 1];
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  }

  template <typename Body>
  void around(float x, float z, const Body& body) const {
    const int cx = cellOf(x), cz = cellOf(z);
    for (int i = std::max(cx - 1, low_x_); i <= std::min(cx + 1, high_x_); ++i)
      for (int k = std::max(cz - 1, low_z_); k <= std::min(cz + 1, high_z_); ++k) {
        const std::size_t cell = number(i, k);
        for (std::size_t e = starts_[cell]; e < starts_[cell + 1]; ++e) body(edges_[e]);
      }
  }

 private:
  static int cellOf(float m) { return static_cast<int>(std::floor(m / kSheet.beyond_m)); }
  std::size_t number(int i, int k) const {
    return static_cast<std::size_t>((i - low_x_) * (high_z_ - low_z_ + 1) + k - low_z_);
  }
  std::size_t at(const Edge& e) const { return number(cellOf(e.x), cellOf(e.z)); }

  std::vector<Edge> edges_;
  std::vector<std::size_t> starts_;
  int low_x_ = 1 << 20, high_x_ = -(1 << 20), low_z_ = 1 << 20, high_z_ = -(1 << 20);
};

}  // namespace

void findSecondEdges(std::span<const SheetPoint> sheets, ModelFrame& frame) {
  std::vector<EdgeGrid::Edge> edges;
  for (const BoundaryPoint& p : frame.boundary)
    if (p.of_blood) edges.push_back({p.x_m, p.z_m, p.nx, p.nz, false, false});
  for (const SheetPoint& p : sheets) edges.push_back({p.x_m, p.z_m, p.nx, p.nz, true, p.end});
  const EdgeGrid grid(std::move(edges));
  for (BoundaryPoint& p : frame.boundary) {
    if (!p.of_blood) continue;
    float second = 0, disc = 0;
    grid.around(p.x_m, p.z_m, [&](const EdgeGrid::Edge& e) {
      const float dx = e.x - p.x_m, dz = e.z - p.z_m, before = -(dx * p.nx + dz * p.nz),
                  across = std::abs(dx * p.nz - dz * p.nx);
      if (e.end)
        disc = std::max(
            disc, kSheet.share(before) *
                      std::clamp((kBesideDisc_m - across) / (kBesideDisc_m - kDisc_m), 0.0f, 1.0f));
      if (across >= kAcross_m) return;
      const float facing = e.nx * p.nx + e.nz * p.nz, hat = 1 - across / kAcross_m;
      second += hat * (e.sheet ? kSheet.share(before) * std::abs(facing)
                               : kBoundary.share(before) * std::max(facing, 0.0f));
    });
    p.alone = std::max(0.0f, 1 - std::max(second, disc));
  }
}

}  // namespace echocine::fit
