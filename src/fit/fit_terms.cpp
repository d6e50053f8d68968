#include "fit/fit_terms.h"

#include "fit/fit_sums.h"

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

void addBoundary(const ModelFrame& frame, const echo::EchoStack& real, const echo::BeatPlace& at,
                 const PoseMapping& map, int stride, double cells_per_m2, RegionSums& region,
                 BoundarySums& sums) {
  for (std::size_t i = 0; i < frame.boundary.size(); i += static_cast<std::size_t>(stride)) {
    const BoundaryPoint& p = frame.boundary[i];
    if (!p.of_blood) continue;
    const auto [x, z, nx, nz, beside, edge] = placedEdge(p, real, at, map);
    const double length = p.length_m * edge.visible;
    if (!(length > 0)) continue;
    addStrip(p, real, at, x, z, nx, nz, beside, cells_per_m2, region);
    sums.square += length * edge.square;
    sums.length += length;
    const MotionPair m = motionOf(p, real, at, map, x, z, nx, nz);
    sums.apart += length * m.weight * m.apart;
    sums.together += length * m.weight * m.together;
  }
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

std::vector<FitTerms> fitTerms(const ModelLoop& model, const echo::EchoStack& real,
                               std::span<const FitPose> poses, const FitStride& stride) {
  std::vector<TermSums> sums(poses.size(), TermSums{{TissueGreys(model.blood)}, {}});
  const double per_m2 = cellsPerArea(model, stride);
  for (std::size_t n = 0; n < model.frames.size(); n += static_cast<std::size_t>(stride.picture))
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const PoseMapping map(poses[i], model.far_m);
      const echo::BeatPlace at = placeOf(model, n, poses[i], real);
      if (!real.seen(at)) continue;
      addCells(model, model.frames[n], real, at, map, stride.cell, sums[i].region);
      addBoundary(model.frames[n], real, at, map, stride.piece, per_m2, sums[i].region,
                  sums[i].boundary);
    }
  std::vector<FitTerms> out;
  for (const TermSums& sum : sums) out.push_back(sum.terms());
  return out;
}

FitTerms fitTerms(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose,
                  const FitStride& stride) {
  return fitTerms(model, real, std::span(&pose, 1), stride).front();
}

}  // namespace echocine::fit
