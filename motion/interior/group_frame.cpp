#include <algorithm>
#include <cmath>

#include "motion/interior/motion_field.h"

namespace echocine {

namespace {

// A cell of the lattice and the place in it, from 0 to 1.
struct InCell {
  std::size_t corner;  // node with the lowest numbers
  float fx, fy, fz;
};

// From a coordinate in nodes to its cell along one axis, held within the lattice.
inline int cellOf(float nodes, int count, float& fraction) {
  const float held = std::clamp(nodes, 0.0f, static_cast<float>(count - 1));
  const int cell = std::min(static_cast<int>(held), count - 2);
  fraction = held - static_cast<float>(cell);
  return cell;
}

inline InCell cellAt(const LatticeGrid& grid, Vec3f p) {
  const float per_m = 1 / grid.spacing_m;
  InCell in{};
  const int ix = cellOf((p.x - grid.origin_m.x) * per_m, grid.nx, in.fx),
            iy = cellOf((p.y - grid.origin_m.y) * per_m, grid.ny, in.fy),
            iz = cellOf((p.z - grid.origin_m.z) * per_m, grid.nz, in.fz);
  in.corner = grid.at(ix, iy, iz);
  return in;
}

inline Vec3f mix(Vec3f a, Vec3f b, float t) {
  return a + t * (b - a);
}

// The cell's eight displacements: d[2 * y + z][x].
struct Corners {
  Vec3f d[4][2];
};

inline Corners cornersOf(const GroupFrame& frame, std::size_t corner) {
  const auto row = static_cast<std::size_t>(frame.grid.nx),
             slab = row * static_cast<std::size_t>(frame.grid.nz);
  Corners c;
  const std::size_t starts[4] = {corner, corner + row, corner + slab, corner + slab + row};
  for (std::size_t i = 0; i < 4; ++i) {
    c.d[i][0] = frame.displacement_m[starts[i]];
    c.d[i][1] = frame.displacement_m[starts[i] + 1];
  }
  return c;
}

inline Vec3f displacementIn(const Corners& c, const InCell& in) {
  const Vec3f low = mix(mix(c.d[0][0], c.d[0][1], in.fx), mix(c.d[1][0], c.d[1][1], in.fx), in.fz),
              high = mix(mix(c.d[2][0], c.d[2][1], in.fx), mix(c.d[3][0], c.d[3][1], in.fx), in.fz);
  return mix(low, high, in.fy);
}

// Columns of the displacement's gradient times the spacing: along x, y, z.
struct Gradient {
  Vec3d x, y, z;
};

Gradient gradientIn(const Corners& c, const InCell& in) {
  const auto along = [&](std::size_t i) { return c.d[i][1] - c.d[i][0]; };
  const auto at = [&](std::size_t i) { return mix(c.d[i][0], c.d[i][1], in.fx); };
  const Vec3f x = mix(mix(along(0), along(1), in.fz), mix(along(2), along(3), in.fz), in.fy),
              z = mix(at(1) - at(0), at(3) - at(2), in.fy),
              y = mix(at(2) - at(0), at(3) - at(1), in.fz);
  return {toDouble(x), toDouble(y), toDouble(z)};
}

// Gradient of the map itself: the identity plus that of the displacement.
Gradient mapGradient(const GroupFrame& frame, const InCell& in) {
  Gradient g = gradientIn(cornersOf(frame, in.corner), in);
  const double per_m = 1.0 / static_cast<double>(frame.grid.spacing_m);
  g = {per_m * g.x, per_m * g.y, per_m * g.z};
  g.x.x += 1;
  g.y.y += 1;
  g.z.z += 1;
  return g;
}

}  // namespace

Vec3f GroupFrame::place(Vec3f p) const {
  if (displacement_m.empty()) return p;
  const InCell in = cellAt(grid, p);
  return p + displacementIn(cornersOf(*this, in.corner), in);
}

void GroupFrame::place(std::span<const Vec3f> reference_m, std::span<Vec3f> placed_m) const {
  for (std::size_t i = 0; i < reference_m.size(); ++i) placed_m[i] = place(reference_m[i]);
}

// Newton's steps with the gradient of the cell; steps are held to a spacing, since the next cell
// has another gradient.
std::optional<Vec3f> GroupFrame::reference(Vec3f placed_m, Vec3f guess_m) const {
  if (displacement_m.empty()) return placed_m;
  constexpr int kMostSteps = 20;
  constexpr float kNear = 1e-6f;  // m
  Vec3f at = guess_m;
  for (int i = 0; i < kMostSteps; ++i) {
    const InCell in = cellAt(grid, at);
    const Vec3f miss = placed_m - (at + displacementIn(cornersOf(*this, in.corner), in));
    if (dot(miss, miss) < kNear * kNear) return at;
    const Gradient g = mapGradient(*this, in);
    const double det = dot(g.x, cross(g.y, g.z));
    if (!(det > 1e-3)) return std::nullopt;
    const Vec3d m = toDouble(miss);
    Vec3d step = (1 / det) *
                 Vec3d{dot(m, cross(g.y, g.z)), dot(m, cross(g.z, g.x)), dot(m, cross(g.x, g.y))};
    const double reach = length(step) / static_cast<double>(grid.spacing_m);
    if (reach > 1) step = (1 / reach) * step;
    at = at + toFloat(step);
  }
  return std::nullopt;
}

double GroupFrame::volumeRatio(Vec3f reference_m) const {
  if (displacement_m.empty()) return 1;
  const Gradient g = mapGradient(*this, cellAt(grid, reference_m));
  return dot(g.x, cross(g.y, g.z));
}

}  // namespace echocine
