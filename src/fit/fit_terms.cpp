#include "fit/fit_terms.h"

#include <algorithm>

#include "fit/fit_sums.h"
#include "fit/seen_cells.h"

namespace echocine::fit {

namespace {

// The mean of (s/S)^2 over the steps of an even p: what a loop without edges gives.
double evenSquare() {
  double sum = 0;
  for (int i = 0; i < kProfileSteps; ++i) {
    const double t = 2.0 * i / (kProfileSteps - 1) - 1;
    sum += t * t / kProfileSteps;
  }
  return sum;
}

struct BoundarySums {
  double square = 0, length = 0;   // of Eq. 4
  double apart = 0, together = 0;  // of Eq. 5
};

void addBoundary(const BoundaryPoint& p, double angle_rad, const PlacedEdge& placed,
                 const echo::EchoInstant& at, const PoseMapping& map, SeenCells& cells,
                 BoundarySums& sums) {
  const auto& [x, z, nx, nz, beside, edge] = placed;
  const double length = p.length_m * p.weight * edge.visible, sure = length * p.alone;
  if (!(length > 0)) return;
  cells.take(p, angle_rad, beside / map.scale());
  sums.square += sure * edge.square;
  sums.length += sure;
  const MotionPair m = motionOf(p, at, map, x, z, nx, nz);
  sums.apart += length * m.weight * m.apart;
  sums.together += length * m.weight * m.together;
}

void addBoundaries(std::span<const BoundaryPoint> points, std::span<const double> angles_rad,
                   const echo::EchoInstant& at, const PoseMapping& map, SeenCells& cells,
                   BoundarySums& sums) {
  forEachPlaced(points, at, map, [&](std::size_t i, const PlacedEdge& placed) {
    addBoundary(points[i], angles_rad[i], placed, at, map, cells, sums);
  });
}

}  // namespace

double fitDiscrepancy(const FitTerms& t, const FitWeights& w) {
  const double sum = w.region + w.boundary + w.motion;
  const double inside = (w.region * t.region + w.boundary * t.boundary + w.motion * t.motion) / sum;
  return t.overlap * inside + 1 - t.overlap;
}

namespace {

struct TermSums {
  RegionSums region;
  BoundarySums boundary;

  FitTerms terms() const {
    static const double kEven = evenSquare();
    FitTerms out;
    if (!(region.seen > 0)) return out;
    out.overlap = region.seen / region.all;
    out.region = region.greys.fit().ratio();
    // Each sum has a small part of the baseline value, so that terms stay continuous where
    // boundaries leave the sector.
    constexpr double kLeast_m = 1e-3, kLeast_m3 = 1e-9;
    out.boundary = (boundary.square / kEven + kLeast_m) / (boundary.length + kLeast_m);
    out.motion = (boundary.apart + kLeast_m3) / (boundary.together + kLeast_m3);
    return out;
  }
};

}  // namespace

PlacedBeat::PlacedBeat(const ModelLoop& model, const echo::EchoStack& real, const FitPose& time,
                       const FitStride& stride)
    : blood_(model.blood), far_m_(model.far_m), seen_(std::make_shared<SeenCells>(model, stride)) {
  for (std::size_t n = 0; n < model.frames.size(); n += static_cast<std::size_t>(stride.picture)) {
    Frame frame{real.instant(placeOf(model, n, time, real)), {}, {}, {}, {}};
    if (!frame.at.seen()) continue;
    const ModelFrame& from = model.frames[n];
    int number = -1;
    const std::size_t most =
        from.cells.size() / static_cast<std::size_t>(stride.cell * stride.cell);
    frame.cells.reserve(most), frame.number.reserve(most);
    for (int i = stride.cell / 2; i < model.cells_across; i += stride.cell)
      for (int k = stride.cell / 2; k < model.cells_along; k += stride.cell) {
        const TissueCell& cell = from.cells[static_cast<std::size_t>(i * model.cells_along + k)];
        ++number;
        if (!(cell.area > 0)) continue;
        frame.cells.push_back(cell);
        frame.number.push_back(number);
      }
    for (std::size_t i = 0; i < from.boundary.size(); i += static_cast<std::size_t>(stride.piece))
      if (from.boundary[i].of_blood) {
        frame.boundary.push_back(from.boundary[i]);
        frame.angles_rad.push_back(SeenCells::angleOf(from.boundary[i]));
      }
    frames_.push_back(std::move(frame));
  }
}

void PlacedBeat::blend() {
  for (Frame& frame : frames_) frame.at.blend();
}

std::vector<FitTerms> PlacedBeat::terms(std::span<const FitPose> poses) const {
  std::vector<TermSums> sums(poses.size(), TermSums{{TissueGreys(blood_)}, {}});
  std::vector<PoseMapping> maps;
  for (const FitPose& pose : poses) maps.emplace_back(pose, far_m_);
  SeenCells seen = *seen_;
  for (const Frame& frame : frames_) {
    seen.start(frame.cells, frame.number);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (i > 0) seen.restart(frame.cells);
      addBoundaries(frame.boundary, frame.angles_rad, frame.at, maps[i], seen, sums[i].boundary);
      addCells(seen.cells(), frame.at, maps[i], sums[i].region);
    }
  }
  std::vector<FitTerms> out;
  for (const TermSums& sum : sums) out.push_back(sum.terms());
  return out;
}

FitTerms fitTerms(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose,
                  const FitStride& stride) {
  return PlacedBeat(model, real, pose, stride).terms({&pose, 1}).front();
}

}  // namespace echocine::fit
