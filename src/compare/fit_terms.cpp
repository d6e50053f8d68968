#include "compare/fit_terms.h"

#include <algorithm>
#include <cmath>

#include "compare/tissue_greys.h"
#include "core/lanes.h"

namespace echocine::compare {

namespace {

constexpr int kProfileSteps = 9;          // along a normal
constexpr double kProfileReach_m = 8e-3;  // S of Eq. 4; our choice
constexpr double kSharpness = 2;          // of p in Eq. 4; our choice
constexpr double kIntoWall_m = 2e-3;      // where walls are tracked: inside them; our choice

// A pose with its sine and cosine.
class Mapping {
 public:
  Mapping(const FitPose& p, double far_m)
      : middle_(far_m / 2),
        x_(p.shift_x_m),
        z_(p.shift_z_m),
        c_(p.scale * std::cos(p.turn_rad)),
        s_(p.scale * std::sin(p.turn_rad)),
        turn_c_(std::cos(p.turn_rad)),
        turn_s_(std::sin(p.turn_rad)) {}
  // Positive turns lead from depth towards lateral, as Placement's rotation does.
  void place(double x, double z, double& rx, double& rz) const {
    const double dz = z - middle_;
    rx = x_ + c_ * x + s_ * dz;
    rz = middle_ + z_ - s_ * x + c_ * dz;
  }
  void turn(double x, double z, double& rx, double& rz) const {
    rx = turn_c_ * x + turn_s_ * z;
    rz = -turn_s_ * x + turn_c_ * z;
  }
  double scale() const { return std::hypot(c_, s_); }

 private:
  double middle_, x_, z_, c_, s_, turn_c_, turn_s_;
};

// p(s) of Eq. 4 as its first two moments, and how far from even it is.
struct EdgeProfile {
  double mean_m = 0, square = 1.0 / 3;  // of s; of (s/S)^2
  double in_sight = 0;                  // of the place itself
  double p[kProfileSteps] = {};

  // 1 - entropy of p over that of an even one.
  double certainty() const {
    double entropy = 0;
    for (const double share : p)
      if (share > 0) entropy -= share * std::log(share);
    return 1 - entropy / std::log(static_cast<double>(kProfileSteps));
  }
};

EdgeProfile profileAt(const EchoStack& real, int picture, double x, double z, double nx, double nz,
                      bool of_blood) {
  EdgeProfile out;
  const double per_scale = kSharpness / real.edgeScale();
  float e[2 * kFloatLanes] = {};
  static_assert(kProfileSteps <= std::size(e));
  for (int i = 0; i < kProfileSteps; ++i) {
    const double s = kProfileReach_m * (2.0 * i / (kProfileSteps - 1) - 1);
    const double px = x + s * nx, pz = z + s * nz;
    // The sector's end shows no edge.
    const EchoStack::Sample g = real.at(picture, px, pz);
    const double edge = (nx * static_cast<double>(g.gx) + nz * static_cast<double>(g.gz)) *
                        static_cast<double>(g.in_sight);
    e[i] = static_cast<float>(per_scale * (of_blood ? edge : std::abs(edge)));
    if (2 * i == kProfileSteps - 1) out.in_sight = g.in_sight;
  }
  for (std::size_t i = 0; i < std::size(e); i += kFloatLanes)
    store(exponential(lanesAt(e + i)), e + i);
  double sum = 0;
  for (int i = 0; i < kProfileSteps; ++i) sum += static_cast<double>(e[i]);
  for (int i = 0; i < kProfileSteps; ++i) out.p[i] = static_cast<double>(e[i]) / sum;
  out.square = 0;
  for (int i = 0; i < kProfileSteps; ++i) {
    const double t = 2.0 * i / (kProfileSteps - 1) - 1;
    out.mean_m += out.p[i] * t * kProfileReach_m;
    out.square += out.p[i] * t * t;
  }
  return out;
}

// The mean of (s/S)^2 over the steps of an even p: what a loop without edges gives.
double evenSquare() {
  double sum = 0;
  for (int i = 0; i < kProfileSteps; ++i) {
    const double t = 2.0 * i / (kProfileSteps - 1) - 1;
    sum += t * t / kProfileSteps;
  }
  return sum;
}

struct RegionSums {
  TissueGreys greys;
  double seen = 0, all = 0;  // areas
};

void addRegion(const ModelLoop& model, const ModelFrame& frame, const EchoStack& real, int picture,
               const Mapping& map, int stride, RegionSums& sums) {
  for (int i = stride / 2; i < model.cells_across; i += stride)
    for (int k = stride / 2; k < model.cells_along; k += stride) {
      const TissueCell& cell = frame.cells[static_cast<std::size_t>(i * model.cells_along + k)];
      if (!(cell.area > 0)) continue;
      double x, z;
      map.place(cell.x_m, cell.z_m, x, z);
      const EchoStack::Sample s = real.at(picture, x, z);
      const double area = cell.area, seen = area * static_cast<double>(s.in_sight);
      sums.all += area;
      if (!(seen > 0)) continue;
      sums.seen += seen;
      const double depth = std::sqrt(x * x + z * z) / real.far();
      sums.greys.add(cell.first, cell.second, cell.share, depth, s.grey, seen);
    }
}

struct BoundarySums {
  double square = 0, length = 0;   // of Eq. 4
  double apart = 0, together = 0;  // of Eq. 5
};

// |u - v|^2 and |u|^2 + |v|^2 of Eq. 5; no weight where nothing is tracked.
struct MotionPair {
  double apart = 0, together = 0, weight = 0;
};
MotionPair motionOf(const BoundaryPoint& p, const EchoStack& real, int picture, const Mapping& map,
                    double x, double z, double nx, double nz) {
  const EchoMotion v = real.motionAt(picture, x + kIntoWall_m * nx, z + kIntoWall_m * nz);
  double ux, uz;
  map.turn(p.dx_m, p.dz_m, ux, uz);
  ux *= map.scale(), uz *= map.scale();
  const double ax = ux - static_cast<double>(v.dx_m), az = uz - static_cast<double>(v.dz_m);
  return {ax * ax + az * az,
          ux * ux + uz * uz + static_cast<double>(v.dx_m) * v.dx_m +
              static_cast<double>(v.dz_m) * v.dz_m,
          v.weight};
}

void addBoundary(const ModelFrame& frame, const EchoStack& real, int picture, const Mapping& map,
                 int stride, BoundarySums& sums) {
  for (std::size_t i = 0; i < frame.boundary.size(); i += static_cast<std::size_t>(stride)) {
    const BoundaryPoint& p = frame.boundary[i];
    if (!p.of_blood) continue;
    double x, z, nx, nz;
    map.place(p.x_m, p.z_m, x, z);
    map.turn(p.nx, p.nz, nx, nz);
    const EdgeProfile edge = profileAt(real, picture, x, z, nx, nz, true);
    const double length = p.length_m * edge.in_sight;
    if (!(length > 0)) continue;
    sums.square += length * edge.square;
    sums.length += length;
    const MotionPair m = motionOf(p, real, picture, map, x, z, nx, nz);
    sums.apart += length * m.weight * m.apart;
    sums.together += length * m.weight * m.together;
  }
}

int pictureOf(int frame, const FitPose& pose, const EchoStack& real) {
  const int n = real.pictures();
  return ((frame + pose.lag) % n + n) % n;
}

}  // namespace

double fitDiscrepancy(const FitTerms& t, const FitWeights& w) {
  const double sum = w.region + w.boundary + w.motion;
  const double inside = (w.region * t.region + w.boundary * t.boundary + w.motion * t.motion) / sum;
  return t.in_sight * inside + 1 - t.in_sight;
}

namespace {

struct TermSums {
  RegionSums region;
  BoundarySums boundary;

  FitTerms terms() const {
    static const double kEven = evenSquare();
    FitTerms out;
    if (!(region.seen > 0)) return out;
    out.in_sight = region.seen / region.all;
    out.region = region.greys.fit().ratio();
    // Each sum has a little of the value that says nothing, so that terms stay continuous where
    // boundaries leave the sector.
    constexpr double kLeast_m = 1e-3, kLeast_m3 = 1e-9;
    out.boundary = (boundary.square / kEven + kLeast_m) / (boundary.length + kLeast_m);
    out.motion = (boundary.apart + kLeast_m3) / (boundary.together + kLeast_m3);
    return out;
  }
};

}  // namespace

std::vector<FitTerms> fitTerms(const ModelLoop& model, const EchoStack& real,
                               std::span<const FitPose> poses, const FitStride& stride) {
  std::vector<TermSums> sums(poses.size(), TermSums{{TissueGreys(model.blood)}, {}});
  for (std::size_t n = 0; n < model.frames.size(); n += static_cast<std::size_t>(stride.picture))
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Mapping map(poses[i], model.far_m);
      const int picture = pictureOf(static_cast<int>(n), poses[i], real);
      if (!real.seen(picture)) continue;
      addRegion(model, model.frames[n], real, picture, map, stride.cell, sums[i].region);
      addBoundary(model.frames[n], real, picture, map, stride.piece, sums[i].boundary);
    }
  std::vector<FitTerms> out;
  for (const TermSums& sum : sums) out.push_back(sum.terms());
  return out;
}

FitTerms fitTerms(const ModelLoop& model, const EchoStack& real, const FitPose& pose,
                  const FitStride& stride) {
  return fitTerms(model, real, std::span(&pose, 1), stride).front();
}

namespace {

// What tissues and gain leave of the grey of each cell, in standard deviations.
std::vector<RegionLeft> leftOver(const ModelFrame& frame, const EchoStack& real, int picture,
                                 const Mapping& map, const TissueGreys::Fit& fit,
                                 double deviation) {
  std::vector<RegionLeft> left;
  for (const TissueCell& cell : frame.cells) {
    if (!(cell.area > 0)) continue;
    double x, z;
    map.place(cell.x_m, cell.z_m, x, z);
    const EchoStack::Sample s = real.at(picture, x, z);
    if (!(s.in_sight > 0)) continue;
    const double place = std::clamp(std::hypot(x, z) / real.far(), 0.0, 1.0) * (kGainKnots - 1);
    const int knot = std::min(static_cast<int>(place), kGainKnots - 2);
    const double gain = fit.gain[knot] + (place - knot) * (fit.gain[knot + 1] - fit.gain[knot]);
    const double grey =
        cell.share * fit.grey[cell.first] +
        (cell.share < 1 ? (1 - static_cast<double>(cell.share)) * fit.grey[cell.second] : 0);
    left.push_back({static_cast<float>(x), static_cast<float>(z),
                    static_cast<float>((s.grey - grey - gain) / deviation)});
  }
  return left;
}

std::vector<BoundaryOffset> offsetsOf(const ModelFrame& frame, const EchoStack& real, int picture,
                                      const Mapping& map) {
  std::vector<BoundaryOffset> out;
  for (const BoundaryPoint& p : frame.boundary) {
    double x, z, nx, nz;
    map.place(p.x_m, p.z_m, x, z);
    map.turn(p.nx, p.nz, nx, nz);
    const EdgeProfile edge = profileAt(real, picture, x, z, nx, nz, p.of_blood);
    if (!(edge.in_sight > 0)) continue;
    const MotionPair m = motionOf(p, real, picture, map, x, z, nx, nz);
    const bool tracked = p.of_blood && m.weight > 0;
    out.push_back({static_cast<float>(x), static_cast<float>(z),
                   static_cast<float>(1e3 * edge.mean_m), static_cast<float>(edge.certainty()),
                   static_cast<float>(tracked ? 1e3 * std::sqrt(m.apart) : -1), p.surface});
  }
  return out;
}

}  // namespace

FitMap fitMap(const ModelLoop& model, const EchoStack& real, const FitPose& pose) {
  const Mapping map(pose, model.far_m);
  RegionSums sums{TissueGreys(model.blood)};
  const auto picture = [&](std::size_t n) { return pictureOf(static_cast<int>(n), pose, real); };
  for (std::size_t n = 0; n < model.frames.size(); ++n)
    if (real.seen(picture(n))) addRegion(model, model.frames[n], real, picture(n), map, 1, sums);
  FitMap out;
  if (!(sums.seen > 0)) return out;
  const TissueGreys::Fit fit = sums.greys.fit();
  const double deviation = std::sqrt(std::max(1e-9, fit.residual / sums.seen));
  out.tissue_grey = fit.grey;
  for (std::size_t n = 0; n < model.frames.size(); ++n) {
    const bool seen = real.seen(picture(n));
    out.region.push_back(seen ? leftOver(model.frames[n], real, picture(n), map, fit, deviation)
                              : std::vector<RegionLeft>{});
    out.boundary.push_back(seen ? offsetsOf(model.frames[n], real, picture(n), map)
                                : std::vector<BoundaryOffset>{});
  }
  return out;
}

}  // namespace echocine::compare
