#include "motion/interior/group_lattice.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Of second differences against a cell's samples. Our choice: tried from 0.001 to 0.1.
constexpr double kStiffness = 0.01;
// The background's nodes stand this many times as far apart.
constexpr int kOpenStride = 2;

// Data of all classes' modes, three columns (x, y, z) per mode.
struct FitData {
  std::vector<std::uint32_t> points;  // border points that take part
  std::vector<LatticeSample> samples;
  std::size_t columns = 0;
  std::vector<float> values;  // columns per point
};

class GroupFitter {
 public:
  GroupFitter(const FieldSpace& space, const GroupMembers& members, const Winners& winners,
              std::span<const BorderPoint> points, std::span<const PhaseClass> classes)
      : space_(space), members_(members), winners_(winners), points_(points), classes_(classes) {}

  GroupLattice fit() {
    if (!gather()) return {};
    layGrid();
    activate();
    makeSamples();
    const std::vector<float> smooth = affinePart();
    subtract(smooth);
    std::vector<float> nodes = fitLattice(lattice_.nodes, data_.samples, data_.values,
                                          data_.columns, kStiffness, restingNodes());
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] += smooth[i];
    fillRows(nodes);
    return std::move(lattice_);
  }

 private:
  bool gather();
  void layGrid();
  void activate();
  void activateInside(std::vector<bool>& active) const;
  void makeSamples();
  void shareWeights();
  std::vector<float> affinePart() const;
  void subtract(const std::vector<float>& nodes);
  std::vector<std::uint32_t> restingNodes() const;
  void fillRows(const std::vector<float>& nodes);
  Vec3d nodePlace(std::size_t node) const;
  double fadeAt(Vec3d place_m) const;
  void inCell(Vec3f place_m, int (&cell)[3], float (&fraction)[3]) const;

  const FieldSpace& space_;
  const GroupMembers& members_;
  const Winners& winners_;
  std::span<const BorderPoint> points_;
  std::span<const PhaseClass> classes_;
  GroupLattice lattice_;
  FitData data_;
};

// The points of this group and what each mode does to them; false when none of them moves.
bool GroupFitter::gather() {
  std::size_t modes = 0;
  for (const PhaseClass& c : classes_) modes += c.modes.count;
  data_.columns = 3 * modes;
  bool moves = false;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (!members_.owns(static_cast<std::uint32_t>(index(points_[i].surface))) &&
        !members_.owns(points_[i].beyond))
      continue;
    data_.points.push_back(i);
    for (const PhaseClass& c : classes_) {
      const std::int32_t order = c.order[i];
      moves |= order >= 0;
      for (std::size_t m = 0; m < c.modes.count; ++m) {
        const Vec3f d = order < 0
                            ? Vec3f{}
                            : c.modes.shapes_m[static_cast<std::size_t>(order) * c.modes.count + m];
        data_.values.insert(data_.values.end(), {d.x, d.y, d.z});
      }
    }
  }
  return moves && data_.columns > 0;
}

// Whole cells of the common lattice about the group's points; all of it for an open group.
void GroupFitter::layGrid() {
  const int stride = members_.open ? kOpenStride : 1;
  const double spacing = stride * space_.spacing_m;
  const Vec3d origin = space_.origin();
  Box box;
  if (members_.open) {
    box.add(origin);
    box.add(space_.moving.hi + (space_.moving.lo - origin));
  } else {
    for (const std::uint32_t i : data_.points) box.add(toDouble(points_[i].reference_m));
  }
  const auto first = [&](double lo, double from) {
    return static_cast<int>(std::floor((lo - from) / spacing)) - (members_.open ? 0 : 2);
  };
  const auto count = [&](double hi, double from, int start) {
    return static_cast<int>(std::ceil((hi - from) / spacing)) - start + (members_.open ? 1 : 3);
  };
  const int x = first(box.lo.x, origin.x), y = first(box.lo.y, origin.y),
            z = first(box.lo.z, origin.z);
  LatticeGrid& grid = lattice_.grid;
  grid.spacing_m = static_cast<float>(spacing);
  grid.origin_m = toFloat(origin + spacing * Vec3d{static_cast<double>(x), static_cast<double>(y),
                                                   static_cast<double>(z)});
  grid.nx = count(box.hi.x, origin.x, x);
  grid.ny = count(box.hi.y, origin.y, y);
  grid.nz = count(box.hi.z, origin.z, z);
}

Vec3d GroupFitter::nodePlace(std::size_t node) const {
  const LatticeGrid& grid = lattice_.grid;
  const auto nx = static_cast<std::size_t>(grid.nx), nz = static_cast<std::size_t>(grid.nz);
  const Vec3d at{static_cast<double>(node % nx), static_cast<double>(node / (nx * nz)),
                 static_cast<double>(node / nx % nz)};
  return toDouble(grid.origin_m) + static_cast<double>(grid.spacing_m) * at;
}

void GroupFitter::inCell(Vec3f p, int (&cell)[3], float (&fraction)[3]) const {
  const LatticeGrid& grid = lattice_.grid;
  const Vec3f d = p - grid.origin_m;
  const float at[3] = {d.x, d.y, d.z};
  const int counts[3] = {grid.nx, grid.ny, grid.nz};
  for (std::size_t i = 0; i < 3; ++i) {
    const float nodes = at[i] / grid.spacing_m;
    cell[i] = std::clamp(static_cast<int>(std::floor(nodes)), 0, counts[i] - 2);
    fraction[i] = std::clamp(nodes - static_cast<float>(cell[i]), 0.0f, 1.0f);
  }
}

// Nodes at which the group wins, and all about them.
void GroupFitter::activateInside(std::vector<bool>& active) const {
  const LatticeGrid& grid = lattice_.grid;
  const Vec3d origin = toDouble(grid.origin_m);
  const auto spacing = static_cast<double>(grid.spacing_m);
  std::vector<std::int16_t> row(static_cast<std::size_t>(grid.nx));
  for (int y = 0; y < grid.ny; ++y)
    for (int z = 0; z < grid.nz; ++z) {
      winners_.alongX(origin.x, spacing, origin.y + y * spacing, origin.z + z * spacing, row);
      for (int x = 0; x < grid.nx; ++x) {
        const std::int16_t winner = row[static_cast<std::size_t>(x)];
        if (winner < 0 || !members_.owns(static_cast<std::uint32_t>(winner))) continue;
        for (int dy = std::max(y - 1, 0); dy <= std::min(y + 1, grid.ny - 1); ++dy)
          for (int dz = std::max(z - 1, 0); dz <= std::min(z + 1, grid.nz - 1); ++dz)
            for (int dx = std::max(x - 1, 0); dx <= std::min(x + 1, grid.nx - 1); ++dx)
              active[grid.at(dx, dy, dz)] = true;
      }
    }
}

void GroupFitter::activate() {
  const LatticeGrid& grid = lattice_.grid;
  std::vector<bool> active(grid.count(), members_.open);
  if (!members_.open) {
    activateInside(active);
    for (const std::uint32_t i : data_.points) {  // the cell of a point and one more all round
      int cell[3];
      float fraction[3];
      inCell(points_[i].reference_m, cell, fraction);
      for (int y = std::max(cell[1] - 1, 0); y <= std::min(cell[1] + 2, grid.ny - 1); ++y)
        for (int z = std::max(cell[2] - 1, 0); z <= std::min(cell[2] + 2, grid.nz - 1); ++z)
          for (int x = std::max(cell[0] - 1, 0); x <= std::min(cell[0] + 2, grid.nx - 1); ++x)
            active[grid.at(x, y, z)] = true;
    }
  }
  ActiveNodes& nodes = lattice_.nodes;
  nodes = {grid.nx, grid.ny, grid.nz, std::vector<std::int32_t>(grid.count(), -1), {}};
  const auto slab = static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.nz);
  for (std::size_t i = 0; i < active.size(); ++i) {
    if (i % slab == 0)
      lattice_.slab_starts.push_back(static_cast<std::uint32_t>(nodes.nodes.size()));
    if (!active[i]) continue;
    nodes.number[i] = static_cast<std::int32_t>(nodes.nodes.size());
    nodes.nodes.push_back(static_cast<std::uint32_t>(i));
  }
  lattice_.slab_starts.push_back(static_cast<std::uint32_t>(nodes.nodes.size()));
}

void GroupFitter::makeSamples() {
  for (const std::uint32_t i : data_.points) {
    int cell[3];
    float f[3];
    inCell(points_[i].reference_m, cell, f);
    LatticeSample sample{};
    for (int corner = 0; corner < 8; ++corner) {
      const int dx = corner & 1, dz = corner >> 1 & 1, dy = corner >> 2;
      sample.node[corner] = static_cast<std::uint32_t>(
          lattice_.nodes.numberAt(cell[0] + dx, cell[1] + dy, cell[2] + dz));
      sample.share[corner] =
          (dx ? f[0] : 1 - f[0]) * (dy ? f[1] : 1 - f[1]) * (dz ? f[2] : 1 - f[2]);
    }
    data_.samples.push_back(sample);
  }
  shareWeights();
}

// A cell's samples weigh 1 together, however finely the surface is meshed.
void GroupFitter::shareWeights() {
  std::vector<std::uint32_t> in_cell(lattice_.nodes.nodes.size(), 0);
  for (const LatticeSample& sample : data_.samples) ++in_cell[sample.node[0]];
  for (LatticeSample& sample : data_.samples)
    sample.weight = 1 / static_cast<float>(in_cell[sample.node[0]]);
}

// 1 within the box of the moving surfaces, 0 from the margin on, smooth between.
double GroupFitter::fadeAt(Vec3d p) const {
  if (!members_.open) return 1;
  const Box& box = space_.moving;
  const double out = std::max({box.lo.x - p.x, p.x - box.hi.x, box.lo.y - p.y, p.y - box.hi.y,
                               box.lo.z - p.z, p.z - box.hi.z, 0.0});
  const double t = std::min(out / space_.margin_m, 1.0);
  return 1 - t * t * (3 - 2 * t);
}

using Matrix3 = double[3][3];

// Solves m x = b for symmetric positive m, by cofactors.
Vec3d solved(const Matrix3& m, Vec3d b) {
  const Vec3d r0{m[0][0], m[0][1], m[0][2]}, r1{m[1][0], m[1][1], m[1][2]},
      r2{m[2][0], m[2][1], m[2][2]};
  const double det = dot(r0, cross(r1, r2));
  return (1 / det) * (b.x * cross(r1, r2) + b.y * cross(r2, r0) + b.z * cross(r0, r1));
}

// The best affine function of place for every column, at the nodes. What is affine is met exactly
// and at any distance; the lattice is fitted to what remains.
std::vector<float> GroupFitter::affinePart() const {
  const std::size_t columns = data_.columns;
  double total = 0;
  Vec3d middle;
  std::vector<double> mean(columns, 0.0);
  for (std::size_t j = 0; j < data_.points.size(); ++j) {
    const auto w = static_cast<double>(data_.samples[j].weight);
    total += w;
    middle = middle + w * toDouble(points_[data_.points[j]].reference_m);
    for (std::size_t c = 0; c < columns; ++c)
      mean[c] += w * static_cast<double>(data_.values[j * columns + c]);
  }
  middle = (1 / total) * middle;
  for (double& m : mean) m /= total;
  Matrix3 spread{};
  std::vector<Vec3d> moment(columns);
  for (std::size_t j = 0; j < data_.points.size(); ++j) {
    const auto w = static_cast<double>(data_.samples[j].weight);
    const Vec3d p = toDouble(points_[data_.points[j]].reference_m) - middle;
    const double at[3] = {p.x, p.y, p.z};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) spread[a][b] += w * at[a] * at[b];
    for (std::size_t c = 0; c < columns; ++c)
      moment[c] =
          moment[c] + (w * (static_cast<double>(data_.values[j * columns + c]) - mean[c])) * p;
  }
  // Holds the slopes that flat or few points leave open at 0.
  const double ridge = 1e-9 * (spread[0][0] + spread[1][1] + spread[2][2]) + 1e-30;
  for (std::size_t a = 0; a < 3; ++a) spread[a][a] += ridge;
  std::vector<Vec3d> slope(columns);
  for (std::size_t c = 0; c < columns; ++c) slope[c] = solved(spread, moment[c]);
  std::vector<float> nodes;
  nodes.reserve(lattice_.nodes.nodes.size() * columns);
  for (const std::uint32_t node : lattice_.nodes.nodes) {
    const Vec3d at = nodePlace(node);
    const double fade = fadeAt(at);
    for (std::size_t c = 0; c < columns; ++c)
      nodes.push_back(static_cast<float>(fade * (mean[c] + dot(slope[c], at - middle))));
  }
  return nodes;
}

// From the data, what given node values already say there.
void GroupFitter::subtract(const std::vector<float>& nodes) {
  const std::size_t columns = data_.columns;
  for (std::size_t j = 0; j < data_.samples.size(); ++j)
    for (std::size_t i = 0; i < 8; ++i) {
      const float share = data_.samples[j].share[i];
      const float* const from = &nodes[data_.samples[j].node[i] * columns];
      for (std::size_t c = 0; c < columns; ++c) data_.values[j * columns + c] -= share * from[c];
    }
}

// An open group's outermost nodes.
std::vector<std::uint32_t> GroupFitter::restingNodes() const {
  std::vector<std::uint32_t> resting;
  if (!members_.open) return resting;
  const LatticeGrid& grid = lattice_.grid;
  for (std::uint32_t n = 0; n < lattice_.nodes.nodes.size(); ++n) {
    const auto node = static_cast<int>(lattice_.nodes.nodes[n]);
    const int x = node % grid.nx, z = node / grid.nx % grid.nz, y = node / (grid.nx * grid.nz);
    if (x == 0 || y == 0 || z == 0 || x == grid.nx - 1 || y == grid.ny - 1 || z == grid.nz - 1)
      resting.push_back(n);
  }
  return resting;
}

// Back from modes to the rows that the weights ask for.
void GroupFitter::fillRows(const std::vector<float>& nodes) {
  const std::size_t columns = data_.columns, count = lattice_.nodes.nodes.size();
  std::size_t first = 0;
  for (const PhaseClass& c : classes_) {
    auto& rows = lattice_.rows_m.emplace_back();
    for (std::size_t r = 0; r < c.weights.rowCount(); ++r) {
      std::vector<float> factors(c.modes.count, 0.0f);
      for (std::size_t m = 0; m < c.modes.count; ++m) {
        double sum = 0;
        if (r < c.weights.keyframeCount())
          sum = c.modes.keyframe_from_mode[r][m];
        else
          for (std::size_t k = 0; k < c.weights.keyframeCount(); ++k)
            sum += c.weights.rowWeights(r)[k] * c.modes.keyframe_from_mode[k][m];
        factors[m] = static_cast<float>(sum);
      }
      std::vector<Vec3f>& row = rows.emplace_back(count);
      for (std::size_t n = 0; n < count; ++n)
        for (std::size_t m = 0; m < c.modes.count; ++m) {
          const float* const v = &nodes[n * columns + first + 3 * m];
          row[n] = row[n] + factors[m] * Vec3f{v[0], v[1], v[2]};
        }
    }
    first += 3 * c.modes.count;
  }
}

}  // namespace

bool GroupMembers::owns(std::uint32_t surface) const {
  return std::find(surfaces.begin(), surfaces.end(), surface) != surfaces.end();
}

GroupLattice fitGroup(const FieldSpace& space, const GroupMembers& members, const Winners& winners,
                      std::span<const BorderPoint> points, std::span<const PhaseClass> classes) {
  return GroupFitter(space, members, winners, points, classes).fit();
}

}  // namespace echocine
