#include "motion/interior/group_cells.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// The background's nodes stand this many times as far apart. Our choice.
constexpr int kOpenStride = 2;

class CellLayer {
 public:
  CellLayer(const FieldSpace& space, const GroupMembers& members, const TopSurfaces& tops,
            std::span<const Vec3f> points_m)
      : space_(space), members_(members), tops_(tops), points_m_(points_m) {}

  GroupCells lay() {
    layGrid();
    activate();
    makeSamples();
    return std::move(cells_);
  }

 private:
  void layGrid();
  void activate();
  void activateInside(std::vector<bool>& active);
  void markOwn();
  void makeSamples();
  void shareWeights();
  void inCell(Vec3f place_m, int (&cell)[3], float (&fraction)[3]) const;

  const FieldSpace& space_;
  const GroupMembers& members_;
  const TopSurfaces& tops_;
  std::span<const Vec3f> points_m_;
  GroupCells cells_;
  std::vector<bool> inside_;  // cells with a node that the group wins, by node of the box
  std::vector<bool> own_;     // nodes that the group wins, by node of the box
};

// Whole cells of the common lattice about the group's points; all of it for an open group.
void CellLayer::layGrid() {
  const int stride = members_.open ? kOpenStride : 1;
  const double spacing = stride * space_.spacing_m;
  const Vec3d origin = space_.origin();
  Box box;
  if (members_.open) {
    box.add(origin);
    box.add(space_.moving.hi + (space_.moving.lo - origin));
  } else {
    for (const Vec3f p : points_m_) box.add(toDouble(p));
  }
  const int beyond = space_.cells_beyond;
  const auto first = [&](double lo, double from) {
    return static_cast<int>(std::floor((lo - from) / spacing)) - (members_.open ? 0 : beyond + 1);
  };
  const auto count = [&](double hi, double from, int start) {
    return static_cast<int>(std::ceil((hi - from) / spacing)) - start +
           (members_.open ? 1 : beyond + 2);
  };
  const int x = first(box.lo.x, origin.x), y = first(box.lo.y, origin.y),
            z = first(box.lo.z, origin.z);
  LatticeGrid& grid = cells_.grid;
  grid.spacing_m = static_cast<float>(spacing);
  grid.origin_m = toFloat(origin + spacing * Vec3d{static_cast<double>(x), static_cast<double>(y),
                                                   static_cast<double>(z)});
  grid.nx = count(box.hi.x, origin.x, x);
  grid.ny = count(box.hi.y, origin.y, y);
  grid.nz = count(box.hi.z, origin.z, z);
}

void CellLayer::inCell(Vec3f p, int (&cell)[3], float (&fraction)[3]) const {
  const LatticeGrid& grid = cells_.grid;
  const Vec3f d = p - grid.origin_m;
  const float at[3] = {d.x, d.y, d.z};
  const int counts[3] = {grid.nx, grid.ny, grid.nz};
  for (std::size_t i = 0; i < 3; ++i) {
    const float nodes = at[i] / grid.spacing_m;
    cell[i] = std::clamp(static_cast<int>(std::floor(nodes)), 0, counts[i] - 2);
    fraction[i] = std::clamp(nodes - static_cast<float>(cell[i]), 0.0f, 1.0f);
  }
}

// Nodes that the group wins.
void CellLayer::markOwn() {
  const LatticeGrid& grid = cells_.grid;
  const Vec3d origin = toDouble(grid.origin_m);
  const auto spacing = static_cast<double>(grid.spacing_m);
  own_.assign(grid.count(), false);
  std::vector<std::int16_t> row(static_cast<std::size_t>(grid.nx));
  for (int y = 0; y < grid.ny; ++y)
    for (int z = 0; z < grid.nz; ++z) {
      tops_.alongX(origin.x, spacing, origin.y + y * spacing, origin.z + z * spacing, row);
      for (int x = 0; x < grid.nx; ++x) {
        const std::int16_t top = row[static_cast<std::size_t>(x)];
        own_[grid.at(x, y, z)] =
            top < 0 ? members_.background : members_.owns(static_cast<std::uint32_t>(top));
      }
    }
}

// The cells around nodes where the group has the highest priority.
void CellLayer::activateInside(std::vector<bool>& active) {
  const LatticeGrid& grid = cells_.grid;
  for (int y = 0; y < grid.ny; ++y)
    for (int z = 0; z < grid.nz; ++z)
      for (int x = 0; x < grid.nx; ++x) {
        if (!own_[grid.at(x, y, z)]) continue;
        for (int corner = 0; corner < 8; ++corner)
          inside_[grid.at(std::max(x - (corner & 1), 0), std::max(y - (corner >> 2), 0),
                          std::max(z - (corner >> 1 & 1), 0))] = true;
        for (int dy = std::max(y - 1, 0); dy <= std::min(y + 1, grid.ny - 1); ++dy)
          for (int dz = std::max(z - 1, 0); dz <= std::min(z + 1, grid.nz - 1); ++dz)
            for (int dx = std::max(x - 1, 0); dx <= std::min(x + 1, grid.nx - 1); ++dx)
              active[grid.at(dx, dy, dz)] = true;
      }
}

void CellLayer::activate() {
  const LatticeGrid& grid = cells_.grid;
  std::vector<bool> active(grid.count(), false);
  inside_.assign(grid.count(), false);
  markOwn();
  activateInside(active);
  const int beyond = space_.cells_beyond;
  for (const Vec3f p : points_m_) {  // the cell of a point and those about it
    int cell[3];
    float fraction[3];
    inCell(p, cell, fraction);
    const auto low = [&](int i) { return std::max(cell[i] - beyond, 0); };
    const auto high = [&](int i, int nodes) { return std::min(cell[i] + 1 + beyond, nodes - 1); };
    for (int y = low(1); y <= high(1, grid.ny); ++y)
      for (int z = low(2); z <= high(2, grid.nz); ++z)
        for (int x = low(0); x <= high(0, grid.nx); ++x) active[grid.at(x, y, z)] = true;
  }
  ActiveNodes& nodes = cells_.nodes;
  nodes = {grid.nx, grid.ny, grid.nz, std::vector<std::int32_t>(grid.count(), -1), {}};
  const auto slab = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.nz);
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (i % slab == 0) cells_.slab_starts.push_back(static_cast<std::uint32_t>(nodes.nodes.size()));
    if (!active[i]) continue;
    nodes.number[i] = static_cast<std::int32_t>(nodes.nodes.size());
    nodes.nodes.push_back(static_cast<std::uint32_t>(i));
  }
  cells_.slab_starts.push_back(static_cast<std::uint32_t>(nodes.nodes.size()));
}

void CellLayer::makeSamples() {
  for (const Vec3f p : points_m_) {
    int cell[3];
    float f[3];
    inCell(p, cell, f);
    LatticeSample sample{};
    for (int corner = 0; corner < 8; ++corner) {
      const int dx = corner & 1, dz = corner >> 1 & 1, dy = corner >> 2;
      sample.node[corner] = static_cast<std::uint32_t>(
          cells_.nodes.numberAt(cell[0] + dx, cell[1] + dy, cell[2] + dz));
      sample.share[corner] =
          (dx ? f[0] : 1 - f[0]) * (dy ? f[1] : 1 - f[1]) * (dz ? f[2] : 1 - f[2]);
    }
    cells_.samples.push_back(sample);
  }
  shareWeights();
}

// A cell's samples weigh 1 together, however finely the surface is meshed.
void CellLayer::shareWeights() {
  cells_.used.assign(cells_.nodes.nodes.size(), false);
  for (std::size_t i = 0; i < cells_.used.size(); ++i) {
    cells_.used[i] = inside_[cells_.nodes.nodes[i]];
    cells_.own.push_back(own_[cells_.nodes.nodes[i]]);
  }
  for (const LatticeSample& sample : cells_.samples) cells_.used[sample.node[0]] = true;
  std::vector<std::uint32_t> in_cell(cells_.nodes.nodes.size(), 0);
  for (const LatticeSample& sample : cells_.samples) ++in_cell[sample.node[0]];
  for (LatticeSample& sample : cells_.samples)
    sample.weight = 1 / static_cast<float>(in_cell[sample.node[0]]);
}

}  // namespace

bool GroupMembers::owns(std::uint32_t surface) const {
  return std::find(surfaces.begin(), surfaces.end(), surface) != surfaces.end();
}

Vec3d GroupCells::placeOf(std::size_t node) const {
  const auto nx = static_cast<std::size_t>(grid.nx), nz = static_cast<std::size_t>(grid.nz);
  const Vec3d at{static_cast<double>(node % nx), static_cast<double>(node / (nx * nz)),
                 static_cast<double>(node / nx % nz)};
  return toDouble(grid.origin_m) + static_cast<double>(grid.spacing_m) * at;
}

GroupCells layCells(const FieldSpace& space, const GroupMembers& members, const TopSurfaces& tops,
                    std::span<const Vec3f> points_m) {
  return CellLayer(space, members, tops, points_m).lay();
}

std::vector<std::uint32_t> outermostNodes(const ActiveNodes& nodes) {
  std::vector<std::uint32_t> outermost;
  for (std::uint32_t n = 0; n < nodes.nodes.size(); ++n) {
    const auto node = static_cast<int>(nodes.nodes[n]);
    const int x = node % nodes.nx, z = node / nodes.nx % nodes.nz, y = node / (nodes.nx * nodes.nz);
    if (x == 0 || y == 0 || z == 0 || x == nodes.nx - 1 || y == nodes.ny - 1 || z == nodes.nz - 1)
      outermost.push_back(n);
  }
  return outermost;
}

}  // namespace echocine
