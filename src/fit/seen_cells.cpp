#include "fit/seen_cells.h"

#include <algorithm>
#include <cmath>

namespace echocine::fit {

SeenCells::SeenCells(const ModelLoop& model, const FitStride& stride)
    : blood_(model.blood.begin(), model.blood.end()), cell_(stride.cell), piece_(stride.piece) {
  const auto counted = [&](int all) { return (all - cell_ / 2 + cell_ - 1) / cell_; };
  across_ = counted(model.cells_across);
  along_ = counted(model.cells_along);
  const std::vector<TissueCell>& cells = model.frames.front().cells;
  const auto angle = [](const TissueCell& c) { return std::atan2(c.x_m, c.z_m); };
  const auto depth = [](const TissueCell& c) { return std::hypot(c.x_m, c.z_m); };
  const TissueCell &a = cells[0], &next = cells[1],
                   &beside = cells[static_cast<std::size_t>(model.cells_along)];
  turn_rad_ = angle(beside) - angle(a);
  step_m_ = depth(next) - depth(a);
  first_rad_ = angle(a) + cell_ / 2 * turn_rad_;
  near_m_ = depth(a) + cell_ / 2 * step_m_;
  turn_rad_ *= cell_, step_m_ *= cell_;
}

void SeenCells::start(std::span<const TissueCell> cells, std::span<const int> number) {
  cells_.assign(cells.begin(), cells.end());
  at_.assign(static_cast<std::size_t>(across_ * along_), -1);
  for (std::size_t i = 0; i < cells_.size(); ++i)
    at_[number.empty() ? i : static_cast<std::size_t>(number[i])] = static_cast<int>(i);
}

double SeenCells::bloodOf(const TissueCell& cell) const {
  const double share = cell.share;
  return share * blood_[cell.first] + (1 - share) * blood_[cell.second];
}

void SeenCells::turn(TissueCell& cell, double share, std::uint8_t tissue) const {
  const bool first = blood_[cell.first] > 0;
  if (first && (cell.share >= 1 || blood_[cell.second] > 0)) {
    cell.second = tissue;
    cell.share = static_cast<float>(1 - share);
  } else {
    const double change = first ? -share : share;
    cell.share = static_cast<float>(std::clamp(cell.share + change, 0.0, 1.0));
  }
}

namespace {

// The arctangent of a tangent of small angles: the error is below 1e-15 rad.
double smallAngle(double tangent) {
  if (std::abs(tangent) > 0.05) return std::atan(tangent);
  const double square = tangent * tangent;
  return tangent * (1 - square * (1.0 / 3 - square * (1.0 / 5 - square * (1.0 / 7 - square / 9))));
}

}  // namespace

double SeenCells::angleOf(const BoundaryPoint& p) {
  return std::atan2(double{p.x_m}, double{p.z_m});
}

// The middle of the strip lies between four cells, which lose in proportion to their nearness and
// blood: D is then continuous in the place.
void SeenCells::take(const BoundaryPoint& p, double angle_rad, double beside_m) {
  if (!(beside_m > 0)) return;
  const double dx = -0.5 * beside_m * p.nx, dz = -0.5 * beside_m * p.nz, x = p.x_m + dx,
               z = p.z_m + dz, ahead = x * p.x_m + z * p.z_m, r = std::sqrt(x * x + z * z),
               angle = ahead > 0 ? angle_rad + smallAngle((dx * p.z_m - dz * p.x_m) / ahead)
                                 : std::atan2(x, z),
               u = (angle - first_rad_) / turn_rad_, v = (r - near_m_) / step_m_;
  const double fu = std::floor(u), fv = std::floor(v);
  TissueCell* near[4];
  double share[4], sum = 0;
  int count = 0;
  for (const int i : {0, 1})
    for (const int k : {0, 1}) {
      const double line = fu + i, sample = fv + k;
      if (line < 0 || line >= across_ || sample < 0 || sample >= along_) continue;
      const int at = at_[static_cast<std::size_t>(line) * static_cast<std::size_t>(along_) +
                         static_cast<std::size_t>(sample)];
      if (at < 0) continue;
      TissueCell& cell = cells_[static_cast<std::size_t>(at)];
      const double blood = bloodOf(cell),
                   close = (1 - std::abs(u - line)) * (1 - std::abs(v - sample));
      if (!(blood * close > 0)) continue;
      near[count] = &cell;
      sum += share[count++] = blood * close;
    }
  if (!(sum > 0)) return;
  const double all = p.length_m * piece_ * beside_m / (step_m_ * turn_rad_ * r);
  for (int n = 0; n < count; ++n)
    turn(*near[n], std::min(bloodOf(*near[n]), all * share[n] / sum), p.beside);
}

}  // namespace echocine::fit
