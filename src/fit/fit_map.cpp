// Where a model disagrees with a loop, place by place.

#include <algorithm>
#include <cmath>

#include "fit/fit_sums.h"
#include "fit/seen_cells.h"

namespace echocine::fit {

namespace {

// Residual of each cell's grey after the fit of tissues and gain, in standard deviations.
std::vector<RegionLeft> leftOver(const std::vector<TissueCell>& cells, const echo::EchoInstant& at,
                                 const PoseMapping& map, const TissueGreys::Fit& fit,
                                 double deviation) {
  std::vector<RegionLeft> left;
  for (const TissueCell& cell : cells) {
    if (!(cell.area > 0)) continue;
    double x, z;
    map.place(cell.x_m, cell.z_m, x, z);
    const echo::EchoStack::Sample s = at.at(x, z);
    if (!(s.visible > 0)) continue;
    const double more =
        fit.left(cell.first, cell.second, cell.share, std::hypot(x, z) / at.stack().far(), s.grey) -
        cell.expected;
    left.push_back(
        {static_cast<float>(x), static_cast<float>(z), static_cast<float>(more / deviation),
         static_cast<std::uint32_t>(&cell - cells.data()), cell.first, cell.second, cell.share});
  }
  return left;
}

std::vector<TissueCell> seenIn(const ModelFrame& frame, const echo::EchoInstant& at,
                               const PoseMapping& map, SeenCells& seen) {
  seen.start(frame.cells);
  for (const BoundaryPoint& p : frame.boundary) {
    if (!p.of_blood) continue;
    double x, z, nx, nz;
    map.place(p.x_m, p.z_m, x, z);
    map.turn(p.nx, p.nz, nx, nz);
    if (at.at(x, z).visible > 0)
      seen.take(p, seenBeside(p, at.stack(), map, x, z, nx, nz) / map.scale());
  }
  return {seen.cells().begin(), seen.cells().end()};
}

std::vector<BoundaryOffset> offsetsOf(const ModelFrame& frame, const echo::EchoInstant& at,
                                      const PoseMapping& map) {
  std::vector<BoundaryOffset> out;
  forEachPlaced(frame.boundary, at, map, [&](std::size_t i, const PlacedEdge& placed) {
    const auto& [x, z, nx, nz, beside, edge] = placed;
    const BoundaryPoint& p = frame.boundary[i];
    if (!(edge.visible > 0)) return;
    const MotionPair m = motionOf(p, at, map, x, z, nx, nz);
    const bool tracked = p.of_blood && m.weight > 0;
    out.push_back({static_cast<float>(x), static_cast<float>(z),
                   static_cast<float>(1e3 * edge.mean_m),
                   p.alone * static_cast<float>(edge.certainty()),
                   static_cast<float>(tracked ? 1e3 * std::sqrt(m.apart) : -1), p.surface,
                   p.segment, p.of_blood, static_cast<std::uint32_t>(i)});
  });
  return out;
}

}  // namespace

FitMap fitMap(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose) {
  const PoseMapping map(pose, model.far_m);
  RegionSums sums{TissueGreys(model.blood)};
  std::vector<echo::EchoInstant> at;
  for (std::size_t n = 0; n < model.frames.size(); ++n)
    at.push_back(real.instant(placeOf(model, n, pose, real)));
  SeenCells seen(model);
  std::vector<std::vector<TissueCell>> cells(at.size());
  for (std::size_t n = 0; n < at.size(); ++n)
    if (at[n].seen()) {
      cells[n] = seenIn(model.frames[n], at[n], map, seen);
      addCells(cells[n], at[n], map, sums);
    }
  FitMap out;
  if (!(sums.seen > 0)) return out;
  const TissueGreys::Fit fit = sums.greys.fit();
  if (!fit.solved) return out;
  const double deviation = std::sqrt(std::max(1e-9, fit.residual / sums.seen));
  out.tissue_grey = fit.grey;
  out.deviation = deviation;
  for (std::size_t n = 0; n < at.size(); ++n) {
    const bool shown = at[n].seen();
    out.region.push_back(shown ? leftOver(cells[n], at[n], map, fit, deviation)
                               : std::vector<RegionLeft>{});
    out.boundary.push_back(shown ? offsetsOf(model.frames[n], at[n], map)
                                 : std::vector<BoundaryOffset>{});
  }
  return out;
}

}  // namespace echocine::fit
