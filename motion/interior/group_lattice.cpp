#include "motion/interior/group_lattice.h"

#include <algorithm>

#include "motion/interior/affine_fit.h"

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

// Data of all classes' modes, three columns (x, y, z) per mode.
struct FitData {
  std::vector<std::uint32_t> points;  // border points that take part
  std::vector<Vec3f> places_m;        // of these
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
    takeCells(layCells(space_, members_, winners_, data_.places_m));
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
  void takeCells(GroupCells cells);
  std::vector<float> affinePart() const;
  void subtract(const std::vector<float>& nodes);
  std::vector<std::uint32_t> restingNodes() const;
  std::vector<float> solve(std::vector<float> start, int steps) const;
  bool stiffenFolds();
  bool folds(const std::uint32_t (&corners)[8]) const;
  bool letSlide(const std::vector<float>& nodes);
  void fillRows(const std::vector<float>& nodes);
  double fadeAt(Vec3d place_m) const;

  const FieldSpace& space_;
  const GroupMembers& members_;
  const Winners& winners_;
  std::span<const BorderPoint> points_;
  std::span<const PhaseClass> classes_;
  GroupLattice lattice_;
  FitData data_;
  std::vector<std::uint32_t> resting_;
  std::vector<float> stiffness_;      // by active node
  std::vector<bool> used_;            // GroupCells::used
  std::vector<Vec3d> node_places_m_;  // by active node
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
    data_.places_m.push_back(points_[i].reference_m);
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

void GroupFitter::takeCells(GroupCells cells) {
  node_places_m_.reserve(cells.nodes.nodes.size());
  for (const std::uint32_t node : cells.nodes.nodes) node_places_m_.push_back(cells.placeOf(node));
  data_.samples = std::move(cells.samples);
  used_ = std::move(cells.used);
  lattice_.grid = cells.grid;
  lattice_.nodes = std::move(cells.nodes);
  lattice_.slab_starts = std::move(cells.slab_starts);
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

// The best affine function of place for every column, at the nodes. What is affine is met exactly
// and at any distance; the lattice is fitted to what remains.
std::vector<float> GroupFitter::affinePart() const {
  const AffineFit fit = affineFit(data_.places_m, data_.samples, data_.values, data_.columns);
  std::vector<float> nodes;
  nodes.reserve(node_places_m_.size() * data_.columns);
  for (const Vec3d at : node_places_m_) {
    const double fade = fadeAt(at);
    for (std::size_t c = 0; c < data_.columns; ++c)
      nodes.push_back(static_cast<float>(fade * fit.at(c, at)));
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

GroupLattice fitGroup(const FieldSpace& space, const GroupMembers& members, const Winners& winners,
                      std::span<const BorderPoint> points, std::span<const PhaseClass> classes) {
  return GroupFitter(space, members, winners, points, classes).fit();
}

}  // namespace echocine
