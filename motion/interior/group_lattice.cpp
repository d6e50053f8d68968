#include "motion/interior/group_lattice.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Of second differences against a cell's samples. Our choice: tried from 0.001 to 0.1.
constexpr float kStiffness = 0.01f;
// Steps of conjugate gradients; more change the fit by less than a hundredth of a millimetre.
constexpr int kFirstSteps = 24, kMoreSteps = 12;
// A cell that keeps less than this part of its volume at a keyframe is about to fold: its
// surroundings are made this much stiffer, so many times at most. Our choices.
constexpr float kLeastVolume = 0.05f, kStiffer = 4;
constexpr int kUnfoldings = 4;
// A neighbour's surface that moves otherwise than the group's own, by this root mean square over
// the keyframes, slides on it: its samples lose three quarters of their weight at twice of it. Our
// choice.
constexpr double kSlides_m = 0.2e-3;
// The background's nodes stand this many times as far apart.
constexpr int kOpenStride = 2;

// Data of all classes' modes, three columns (x, y, z) per mode.
struct FitData {
  std::vector<std::uint32_t> points;  // border points that take part
  std::vector<LatticeSample> samples;
  std::size_t columns = 0;
  std::vector<float> values;  // columns per point
};

std::vector<float> sum(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> total(a);
  for (std::size_t i = 0; i < total.size(); ++i) total[i] += b[i];
  return total;
}

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
    resting_ = restingNodes();
    stiffness_.assign(lattice_.nodes.nodes.size(), kStiffness);
    std::vector<float> rest = solve({}, kFirstSteps);
    if (letSlide(rest)) rest = solve(std::move(rest), kMoreSteps);
    fillRows(sum(smooth, rest));
    for (int i = 0; i < kUnfoldings && stiffenFolds(); ++i) {
      rest = solve(std::move(rest), kMoreSteps);
      fillRows(sum(smooth, rest));
    }
    return std::move(lattice_);
  }

 private:
  bool gather();
  void layGrid();
  void activate();
  void activateInside(std::vector<bool>& active);
  void makeSamples();
  void shareWeights();
  std::vector<float> affinePart() const;
  void subtract(const std::vector<float>& nodes);
  std::vector<std::uint32_t> restingNodes() const;
  std::vector<float> solve(std::vector<float> start, int steps) const;
  bool stiffenFolds();
  bool folds(const std::uint32_t (&corners)[8]) const;
  bool letSlide(const std::vector<float>& nodes);
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
  std::vector<std::uint32_t> resting_;
  std::vector<float> stiffness_;  // by active node
  std::vector<bool> inside_;      // cells with a node that the group wins, by node of the box
  std::vector<bool> used_;        // cells that hold something of the group, by their first node
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
void GroupFitter::activateInside(std::vector<bool>& active) {
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
        for (int corner = 0; corner < 8; ++corner)
          inside_[grid.at(std::max(x - (corner & 1), 0), std::max(y - (corner >> 2), 0),
                          std::max(z - (corner >> 1 & 1), 0))] = true;
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
  inside_.assign(grid.count(), members_.open);
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
  used_.assign(lattice_.nodes.nodes.size(), false);
  for (std::size_t i = 0; i < used_.size(); ++i) used_[i] = inside_[lattice_.nodes.nodes[i]];
  for (const LatticeSample& sample : data_.samples) used_[sample.node[0]] = true;
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

// Where a neighbour's surface and the group's own cannot both be met, they slide on one another:
// the neighbour gives way. Modes are orthonormal over the keyframes, so the sum of squares over
// modes is that over keyframes. False when nothing changes.
bool GroupFitter::letSlide(const std::vector<float>& nodes) {
  std::size_t keyframes = 0;
  for (const PhaseClass& c : classes_) keyframes = std::max(keyframes, c.weights.keyframeCount());
  bool slides = false;
  const std::size_t columns = data_.columns;
  std::vector<double> miss(columns);
  for (std::size_t j = 0; j < data_.samples.size(); ++j) {
    const BorderPoint& point = points_[data_.points[j]];
    if (members_.owns(static_cast<std::uint32_t>(index(point.surface)))) continue;
    LatticeSample& sample = data_.samples[j];
    for (std::size_t c = 0; c < columns; ++c)
      miss[c] = static_cast<double>(data_.values[j * columns + c]);
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t c = 0; c < columns; ++c)
        miss[c] -= static_cast<double>(sample.share[i] * nodes[sample.node[i] * columns + c]);
    double square_m2 = 0;
    for (const double m : miss) square_m2 += m * m / static_cast<double>(keyframes);
    const double factor = 1 / (1 + square_m2 / (kSlides_m * kSlides_m));
    slides |= factor < 0.5;
    sample.weight *= static_cast<float>(factor);
  }
  return slides;
}

std::vector<float> GroupFitter::solve(std::vector<float> start, int steps) const {
  return fitLattice(lattice_.nodes, data_.samples, data_.values, data_.columns, stiffness_,
                    resting_, std::move(start), steps);
}

// Does the map turn over, or nearly, at a corner of the cell at any keyframe? Corner numbers have
// bit 0 for x, 1 for z, 2 for y.
bool GroupFitter::folds(const std::uint32_t (&corners)[8]) const {
  const float h = lattice_.grid.spacing_m;
  for (std::size_t c = 0; c < classes_.size(); ++c)
    for (std::size_t k = 0; k < classes_[c].weights.keyframeCount(); ++k) {
      const std::vector<Vec3f>& row = lattice_.rows_m[c][k];
      Vec3f d[8];
      for (std::size_t i = 0; i < 8; ++i) d[i] = row[corners[i]];
      for (std::size_t i = 0; i < 8; ++i) {
        const Vec3f x = Vec3f{h, 0, 0} + d[i | 1] - d[i & 6],
                    z = Vec3f{0, 0, h} + d[i | 2] - d[i & 5],
                    y = Vec3f{0, h, 0} + d[i | 4] - d[i & 3];
        if (dot(x, cross(y, z)) < kLeastVolume * h * h * h) return true;
      }
    }
  return false;
}

// False when no cell folds.
bool GroupFitter::stiffenFolds() {
  const LatticeGrid& grid = lattice_.grid;
  std::vector<bool> stiffer(stiffness_.size(), false);
  bool found = false;
  for (int y = 0; y + 1 < grid.ny; ++y)
    for (int z = 0; z + 1 < grid.nz; ++z)
      for (int x = 0; x + 1 < grid.nx; ++x) {
        std::uint32_t corners[8];
        bool whole = true;
        for (int i = 0; i < 8; ++i) {
          const std::int32_t n =
              lattice_.nodes.numberAt(x + (i & 1), y + (i >> 2), z + (i >> 1 & 1));
          whole &= n >= 0;
          corners[i] = static_cast<std::uint32_t>(n);
        }
        if (!whole || !used_[corners[0]] || !folds(corners)) continue;
        found = true;
        for (const std::uint32_t n : corners) stiffer[n] = true;
      }
  for (std::size_t n = 0; n < stiffer.size(); ++n)
    if (stiffer[n]) stiffness_[n] *= kStiffer;
  return found;
}

// Back from modes to the rows that the weights ask for.
void GroupFitter::fillRows(const std::vector<float>& nodes) {
  const std::size_t columns = data_.columns, count = lattice_.nodes.nodes.size();
  std::size_t first = 0;
  lattice_.rows_m.clear();
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
