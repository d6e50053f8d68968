#include "fit/fit_residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/boundary_sides.h"
#include "fit/fit_sums.h"
#include "fit/seen_cells.h"

namespace echocine::fit {

namespace {

// Added to the weight of a direction, so that residuals fade where it empties: a millimetre of
// boundary in a frame. Our choice.
constexpr double kFade_m = 1e-3;

// Sums of one direction of a structure in a frame.
struct SideSums {
  double length = 0, offset = 0;      // m; of s / S
  double weight = 0, dx = 0, dz = 0;  // of u - v
};

class ResidualBuilder {
 public:
  ResidualBuilder(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose)
      : model_(model),
        map_(pose, model.far_m),
        seen_(model.frames.size()),
        sides_(model.frames.size() * model.structures.size() * kSides),
        sums_{TissueGreys(model.blood)} {
    SeenCells seen(model);
    for (std::size_t n = 0; n < model.frames.size(); ++n) {
      at_.push_back(real.instant(placeOf(model, n, pose, real)));
      if (!at_[n].seen()) continue;
      seen.start(model.frames[n].cells);
      addSides(n, at_[n], seen);
      seen_[n].assign(seen.cells().begin(), seen.cells().end());
      addCells(seen_[n], at_[n], map_, sums_);
    }
  }

  std::vector<double> residuals(const FitTerms& terms, const FitWeights& w) const {
    const double all = w.region + w.boundary + w.motion;
    std::vector<double> out;
    addGreys(std::sqrt(terms.overlap * w.region / all), out);
    const double edge = std::sqrt(terms.overlap * w.boundary / (all * kEven * length_)),
                 motion = std::sqrt(terms.overlap * w.motion / (all * together_));
    for (const SideSums& s : sides_) {
      const double by_length = 1 / std::sqrt(s.length + kFade_m),
                   by_weight = 1 / std::sqrt(s.weight + kFade_m);
      out.insert(out.end(), {edge * by_length * s.offset, motion * by_weight * s.dx,
                             motion * by_weight * s.dz});
    }
    double square = 0;
    for (const double r : out) square += r * r;
    out.push_back(std::sqrt(std::max(0.0, 1 + fitDiscrepancy(terms, w) - square)));
    return out;
  }

 private:
  void addSides(std::size_t n, const echo::EchoInstant& at, SeenCells& seen) {
    const ModelFrame& frame = model_.frames[n];
    const std::vector<BoundaryMiddle> middles = middlesOf(frame, model_.structures.size());
    forEachPlaced(frame.boundary, at, map_, [&](std::size_t i, const PlacedEdge& placed) {
      const auto& [x, z, nx, nz, beside, edge] = placed;
      const BoundaryPoint& p = frame.boundary[i];
      const double length = p.length_m * p.weight * edge.visible, sure = length * p.alone;
      if (!p.of_blood || !(length > 0)) return;
      seen.take(p, beside / map_.scale());
      const MotionPair m = motionOf(p, at, map_, x, z, nx, nz);
      length_ += sure;
      together_ += length * m.weight * m.together;
      const SideShares sides = sidesOf(p, middles[p.surface]);
      const std::size_t row = (n * model_.structures.size() + p.surface) * kSides;
      addTo(sides_[row + sides.first], 1 - sides.share, sure, length * m.weight, edge, m);
      addTo(sides_[row + sides.second], sides.share, sure, length * m.weight, edge, m);
    });
  }
  // A share of a piece, by its weights for the edge and for the motion.
  static void addTo(SideSums& s, double share, double sure, double tracked, const EdgeProfile& edge,
                    const MotionPair& m) {
    s.length += share * sure;
    s.offset += share * sure * edge.mean_m / kProfileReach_m;
    s.weight += share * tracked;
    s.dx += share * tracked * m.dx;
    s.dz += share * tracked * m.dz;
  }

  void addGreys(double factor, std::vector<double>& out) const {
    const std::size_t cells = model_.frames.front().cells.size();
    const TissueGreys::Fit fit = sums_.greys.fit();
    const bool known = sums_.seen > 0 && fit.solved && fit.total > 0;
    for (std::size_t n = 0; n < model_.frames.size(); ++n) {
      const echo::EchoInstant& at = at_[n];
      if (!known || !at.seen()) {
        out.insert(out.end(), cells, 0.0);
        continue;
      }
      for (const TissueCell& cell : seen_[n])
        out.push_back(factor * std::sqrt(1 / fit.total) * leftOf(cell, at, fit));
    }
  }
  // Square root of the seen area, times grey minus that of the cell's tissues and the gain.
  double leftOf(const TissueCell& cell, const echo::EchoInstant& at,
                const TissueGreys::Fit& fit) const {
    if (!(cell.area > 0)) return 0;
    double x, z;
    map_.place(cell.x_m, cell.z_m, x, z);
    const echo::EchoStack::Sample s = at.at(x, z);
    if (!(s.visible > 0)) return 0;
    const double left = std::sqrt(static_cast<double>(cell.area) * static_cast<double>(s.visible)) *
                        (fit.left(cell.first, cell.second, cell.share,
                                  std::hypot(x, z) / at.stack().far(), s.grey) -
                         static_cast<double>(cell.expected));
    return std::isfinite(left) ? left : 0;  // a tissue that is hardly seen has no grey
  }

  static constexpr double kLeast_m = 1e-3, kLeast_m3 = 1e-9;  // as in fitTerms()
  // Mean of (s/S)^2 of an even p: 1/3 (n + 1) / (n - 1) of n places.
  static constexpr double kEven = (kProfileSteps + 1.0) / (kProfileSteps - 1.0) / 3;

  const ModelLoop& model_;
  PoseMapping map_;
  std::vector<echo::EchoInstant> at_;          // by frame
  std::vector<std::vector<TissueCell>> seen_;  // cells of each frame in view
  std::vector<SideSums> sides_;                // by frame, structure and direction
  RegionSums sums_;
  double length_ = kLeast_m, together_ = kLeast_m3;
};

}  // namespace

std::vector<double> residualsOf(const ModelDiscrepancy& discrepancy, const ModelLoop& model,
                                const FitPose& pose) {
  const PoseFound at = discrepancy.at(model, pose);
  return ResidualBuilder(model, discrepancy.stack(), pose)
      .residuals(at.terms, discrepancy.settings().weights);
}

ResidualColumns residualColumns(const ModelDiscrepancy& discrepancy, const ModelOfUnknowns& model,
                                const std::vector<double>& at, const std::vector<double>& steps,
                                const FitPose& pose) {
  if (steps.size() != at.size() ||
      !std::all_of(steps.begin(), steps.end(), [](double step) { return step > 0; }))
    throw SceneError(
        fmt::format("steps: accepted: one positive number for each of {} unknowns", at.size()));
  constexpr std::size_t kPoseColumns = 4;
  const ModelLoop middle = model(at);
  const auto side = [&](std::size_t unknown, double sign) {
    if (unknown < at.size()) {
      std::vector<double> moved = at;
      moved[unknown] += sign * steps[unknown];
      return residualsOf(discrepancy, model(moved), pose);
    }
    FitPose moved = pose;
    const std::size_t column = unknown - at.size();
    if (column == 0) moved.shift_x_m += sign * kShiftStep_m;
    if (column == 1) moved.shift_z_m += sign * kShiftStep_m;
    if (column == 2) moved.turn_rad += sign * kTurnStep_rad;
    if (column == 3) moved.scale += sign * kScaleStep;
    return residualsOf(discrepancy, middle, moved);
  };
  ResidualColumns out{residualsOf(discrepancy, middle, pose), {}};
  out.columns.resize(at.size() + kPoseColumns);
  constexpr double kPoseSteps[kPoseColumns] = {kShiftStep_m, kShiftStep_m, kTurnStep_rad,
                                               kScaleStep};
  parallelBlocks(out.columns.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t u = begin; u < end; ++u) {
      const std::vector<double> high = side(u, 1), low = side(u, -1);
      const double step = u < at.size() ? steps[u] : kPoseSteps[u - at.size()];
      for (std::size_t i = 0; i < high.size(); ++i)
        out.columns[u].push_back((high[i] - low[i]) / (2 * step));
    }
  });
  return out;
}

}  // namespace echocine::fit
