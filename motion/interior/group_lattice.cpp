#include "motion/interior/group_lattice.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "motion/interior/affine_fit.h"
#include "motion/interior/folds.h"
#include "motion/interior/quadratic_fit.h"

namespace echocine {

namespace {

// Modes of what the affine part leaves that are smaller than this part of it, as root mean squares,
// are left out: some hundredths of a millimetre at most. Our choice.
constexpr double kLeftOut = 0.02;
// Residuals, in parts of the right side: of fits that only decide what slides and what folds, and
// of the field. Our choices.
constexpr double kTrial = 1e-2, kConverged = 1e-6;
// Rounds in which what folds is made stiffer, at most. Our choice.
constexpr int kUnfoldings = 2;
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

class GroupFitter {
 public:
  GroupFitter(const FieldSpace& space, const GroupMembers& members, const TopSurfaces& tops,
              std::span<const BorderPoint> points, std::span<const PhaseClass> classes)
      : space_(space), members_(members), tops_(tops), points_(points), classes_(classes) {}

  GroupLattice fit() {
    if (!gather()) return {};
    takeCells(layCells(space_, members_, tops_, data_.places_m));
    affine_ = affineFit(data_.places_m, data_.samples, data_.values, data_.columns);
    subtractAffine();
    keepFewModes();
    subtractQuadratic();
    if (members_.open) resting_ = outermostNodes(lattice_.nodes);
    stiffness_.assign(lattice_.nodes.nodes.size(), 1.0f);
    equations_.emplace(lattice_.nodes, data_.samples, stiffness_, own_, resting_);
    std::vector<float> rest = solve({}, kTrial);
    if (letSlide(rest)) {
      equations_->update(stiffness_);
      rest = solve(std::move(rest), kTrial);
    }
    fillRows(rest);
    for (int i = 1; stiffenFolds(lattice_, classes_, used_, stiffness_); ++i) {
      equations_->update(stiffness_);
      if (i == kUnfoldings) break;
      rest = solve(std::move(rest), kTrial);
      fillRows(rest);
    }
    fillRows(solve(std::move(rest), kConverged));
    return std::move(lattice_);
  }

 private:
  bool gather();
  void takeCells(GroupCells cells);
  void subtractAffine();
  void subtractQuadratic();
  std::vector<float> solve(std::vector<float> start, double tolerance);
  bool letSlide(const std::vector<float>& nodes);
  std::size_t keyframeCount() const;
  void keepFewModes();
  void fillRows(const std::vector<float>& rest);
  void fillRow(const std::vector<double>& factors, const std::vector<float>& rest,
               std::vector<Vec3f>& row) const;
  double fadeAt(Vec3d place_m) const;

  const FieldSpace& space_;
  const GroupMembers& members_;
  const TopSurfaces& tops_;
  std::span<const BorderPoint> points_;
  std::span<const PhaseClass> classes_;
  GroupLattice lattice_;
  FitData data_;
  AffineFit affine_;  // of all modes
  MotionModes few_;   // of what remains: the classes' modes take the keyframes' place
  std::vector<float>
      base_;  // columns values per active node; the lattice is fitted to what remains
  std::vector<std::uint32_t> resting_;
  std::optional<LatticeFit> equations_;  // of the weights and the stiffness as they are
  std::vector<float> stiffness_;         // by active node, in parts of that of all
  std::vector<bool> own_;                // GroupCells::own
  std::vector<bool> used_;               // GroupCells::used
  std::vector<Vec3d> node_places_m_;     // by active node
  std::vector<double> fade_;             // of the affine part, by active node
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
  own_ = std::move(cells.own);
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

// The best affine function of place, by its values at the nodes, is subtracted from the data. So
// affine motion is exact at any distance; the lattice is fitted to the remainder.
void GroupFitter::subtractAffine() {
  for (const Vec3d at : node_places_m_) fade_.push_back(fadeAt(at));
  const std::size_t columns = data_.columns;
  for (std::size_t j = 0; j < data_.samples.size(); ++j) {
    const LatticeSample& sample = data_.samples[j];
    double fade = 0;
    Vec3d arm;
    for (std::size_t i = 0; i < 8; ++i) {
      const std::uint32_t n = sample.node[i];
      const double share = static_cast<double>(sample.share[i]) * fade_[n];
      fade += share;
      arm = arm + share * (node_places_m_[n] - affine_.middle);
    }
    for (std::size_t c = 0; c < columns; ++c)
      data_.values[j * columns + c] -=
          static_cast<float>(fade * affine_.mean[c] + dot(affine_.slope[c], arm));
  }
}

// The remainder without the affine part is mostly a few modes. Their columns replace those of the
// data.
void GroupFitter::keepFewModes() {
  std::vector<Vec3f> remains_m;
  remains_m.reserve(data_.values.size() / 3);
  for (std::size_t i = 0; i < data_.values.size(); i += 3)
    remains_m.push_back({data_.values[i], data_.values[i + 1], data_.values[i + 2]});
  double squares_m2 = 0;  // over points and keyframes, since the classes' modes are orthonormal
  for (const Vec3f d : remains_m) squares_m2 += static_cast<double>(dot(d, d));
  const auto points = static_cast<double>(data_.points.size());
  few_ = motionModes(remains_m, data_.columns / 3, kLeftOut * std::sqrt(squares_m2 / points));
  data_.columns = 3 * few_.count;
  data_.values.clear();
  for (const Vec3f d : few_.shapes_m) data_.values.insert(data_.values.end(), {d.x, d.y, d.z});
  few_.shapes_m = {};
}

void GroupFitter::subtractQuadratic() {
  if (members_.open)
    base_.assign(node_places_m_.size() * data_.columns, 0.0f);
  else
    base_ =
        takeQuadratic(data_.places_m, data_.samples, node_places_m_, data_.columns, data_.values);
}

std::size_t GroupFitter::keyframeCount() const {
  std::size_t keyframes = 0;
  for (const PhaseClass& c : classes_) keyframes = std::max(keyframes, c.weights.keyframeCount());
  return keyframes;
}

// Where a neighbour's surface and the group's own cannot both be met, they slide on one another:
// the neighbour gives way. Modes are orthonormal over the keyframes, so the sum of squares over
// modes is that over keyframes. False when nothing changes.
bool GroupFitter::letSlide(const std::vector<float>& nodes) {
  const auto keyframes = static_cast<double>(keyframeCount());
  bool slides = false;
  const std::size_t columns = data_.columns;
  std::vector<double> miss(columns);
  std::vector<float> factors(data_.samples.size(), 1.0f);
  for (std::size_t j = 0; j < data_.samples.size(); ++j) {
    const BorderPoint& point = points_[data_.points[j]];
    if (members_.owns(static_cast<std::uint32_t>(index(point.surface)))) continue;
    const LatticeSample& sample = data_.samples[j];
    for (std::size_t c = 0; c < columns; ++c)
      miss[c] = static_cast<double>(data_.values[j * columns + c]);
    for (std::size_t i = 0; i < 8; ++i)
      for (std::size_t c = 0; c < columns; ++c)
        miss[c] -= static_cast<double>(sample.share[i] * nodes[sample.node[i] * columns + c]);
    double square_m2 = 0;
    for (const double m : miss) square_m2 += m * m / keyframes;
    const double factor = 1 / (1 + square_m2 / (kSlides_m * kSlides_m));
    slides |= factor < 0.5;
    factors[j] = static_cast<float>(factor);
  }
  // The equations keep the old weights until they are updated.
  for (std::size_t j = 0; slides && j < factors.size(); ++j) data_.samples[j].weight *= factors[j];
  return slides;
}

std::vector<float> GroupFitter::solve(std::vector<float> start, double tolerance) {
  LatticeFit::Solution solution =
      equations_->solve(data_.values, data_.columns, std::move(start), tolerance);
  lattice_.residual = solution.residual;
  return std::move(solution.values);
}

// Back from modes to the rows that the weights ask for.
void GroupFitter::fillRows(const std::vector<float>& rest) {
  const std::size_t modes = affine_.mean.size() / 3;
  std::size_t first = 0;
  lattice_.rows_m.clear();
  for (const PhaseClass& c : classes_) {
    auto& rows = lattice_.rows_m.emplace_back(c.weights.rowCount());
    for (std::size_t r = 0; r < rows.size(); ++r) {
      std::vector<double> factors(modes, 0.0);
      for (std::size_t m = 0; m < c.modes.count; ++m)
        if (r < c.weights.keyframeCount())
          factors[first + m] = c.modes.keyframe_from_mode[r][m];
        else
          for (std::size_t k = 0; k < c.weights.keyframeCount(); ++k)
            factors[first + m] += c.weights.rowWeights(r)[k] * c.modes.keyframe_from_mode[k][m];
      fillRow(factors, rest, rows[r]);
    }
    first += c.modes.count;
  }
}

// The modes by their factors: the affine part, and the few of the rest.
void GroupFitter::fillRow(const std::vector<double>& factors, const std::vector<float>& rest,
                          std::vector<Vec3f>& row) const {
  double mean[3] = {};
  Vec3d slope[3];
  std::vector<double> few(few_.count, 0.0);
  for (std::size_t m = 0; m < factors.size(); ++m) {
    for (std::size_t i = 0; i < 3; ++i) {
      mean[i] += factors[m] * affine_.mean[3 * m + i];
      slope[i] = slope[i] + factors[m] * affine_.slope[3 * m + i];
    }
    for (std::size_t k = 0; k < few.size(); ++k)
      few[k] += factors[m] * few_.keyframe_from_mode[m][k];
  }
  const std::vector<float> shares(few.begin(), few.end());
  row.resize(node_places_m_.size());
  for (std::size_t n = 0; n < row.size(); ++n) {
    const Vec3d arm = node_places_m_[n] - affine_.middle;
    row[n] = toFloat(fade_[n] * Vec3d{mean[0] + dot(slope[0], arm), mean[1] + dot(slope[1], arm),
                                      mean[2] + dot(slope[2], arm)});
    const float* from = &rest[n * data_.columns];
    const float* base = &base_[n * data_.columns];
    for (std::size_t k = 0; k < shares.size(); ++k, from += 3, base += 3)
      row[n] = row[n] + shares[k] * Vec3f{base[0] + from[0], base[1] + from[1], base[2] + from[2]};
  }
}

}  // namespace

GroupLattice fitGroup(const FieldSpace& space, const GroupMembers& members, const TopSurfaces& tops,
                      std::span<const BorderPoint> points, std::span<const PhaseClass> classes) {
  return GroupFitter(space, members, tops, points, classes).fit();
}

}  // namespace echocine
