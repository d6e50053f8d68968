#include "fit/fit_sums.h"

#include <algorithm>
#include <initializer_list>

#include "core/lanes.h"

namespace echocine::fit {

namespace {

constexpr double kSharpness = 2;      // of p in Eq. 4; our choice
constexpr double kIntoWall_m = 2e-3;  // where walls are tracked: inside them; our choice

}  // namespace

double EdgeProfile::certainty() const {
  double entropy = 0;
  for (const double share : p)
    if (share > 0) entropy -= share * std::log(share);
  return 1 - entropy / std::log(static_cast<double>(kProfileSteps));
}

EdgeProfile edgeProfileAt(const echo::EchoInstant& at, double x, double z, double nx, double nz,
                          bool of_blood) {
  EdgeProfile out;
  const double per_scale = kSharpness / at.stack().edgeScale();
  float e[2 * kFloatLanes] = {};
  static_assert(kProfileSteps == kFloatLanes + 1);
  constexpr auto kReach = static_cast<float>(kProfileReach_m);
  constexpr Floats8 kSteps{-1, -0.75f, -0.5f, -0.25f, 0, 0.25f, 0.5f, 0.75f};
  echo::EchoStack::Sample samples[kProfileSteps];
  at.at(static_cast<float>(x) + static_cast<float>(nx) * kReach * kSteps,
        static_cast<float>(z) + static_cast<float>(nz) * kReach * kSteps, samples);
  samples[kFloatLanes] = at.at(x + kProfileReach_m * nx, z + kProfileReach_m * nz);
  for (int i = 0; i < kProfileSteps; ++i) {
    // The sector's end shows no edge.
    const echo::EchoStack::Sample& g = samples[i];
    const double edge = (nx * static_cast<double>(g.gx) + nz * static_cast<double>(g.gz)) *
                        static_cast<double>(g.visible);
    e[i] = static_cast<float>(per_scale * (of_blood ? edge : std::abs(edge)));
  }
  out.visible = samples[kProfileSteps / 2].visible;
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

double seenBeside(const echo::EchoStack& real, double x, double z, double nx, double nz) {
  const double r = std::sqrt(x * x + z * z);
  return r > 0 ? real.spread().shift(r, (nx * x + nz * z) / r) : 0;
}

PlacedEdge placedEdge(const BoundaryPoint& p, const echo::EchoInstant& at, const PoseMapping& map) {
  PlacedEdge out;
  map.place(p.x_m, p.z_m, out.x, out.z);
  map.turn(p.nx, p.nz, out.nx, out.nz);
  if (p.of_blood) out.beside = seenBeside(at.stack(), out.x, out.z, out.nx, out.nz);
  out.edge = edgeProfileAt(at, out.x - out.beside * out.nx, out.z - out.beside * out.nz, out.nx,
                           out.nz, p.of_blood);
  return out;
}

MotionPair motionOf(const BoundaryPoint& p, const echo::EchoInstant& at, const PoseMapping& map,
                    double x, double z, double nx, double nz) {
  const echo::EchoMotion v = at.motionAt(x + kIntoWall_m * nx, z + kIntoWall_m * nz);
  double ux, uz;
  map.turn(p.dx_m, p.dz_m, ux, uz);
  ux *= map.scale(), uz *= map.scale();
  const double ax = ux - static_cast<double>(v.dx_m), az = uz - static_cast<double>(v.dz_m);
  return {ax * ax + az * az,
          ux * ux + uz * uz + static_cast<double>(v.dx_m) * v.dx_m +
              static_cast<double>(v.dz_m) * v.dz_m,
          v.weight, ax, az};
}

void addCells(std::span<const TissueCell> cells, const echo::EchoInstant& at,
              const PoseMapping& map, RegionSums& sums) {
  const TissueCell* some[kFloatLanes];
  std::size_t count = 0;
  const auto add = [&] {
    Floats8 x{}, z{};
    for (std::size_t lane = 0; lane < count; ++lane)
      x[lane] = some[lane]->x_m, z[lane] = some[lane]->z_m;
    map.place(x, z);
    echo::EchoStack::Sample samples[kFloatLanes];
    at.at(x, z, samples);
    const Floats8 squares = x * x + z * z;
    const double per_far = 1 / at.stack().far();
    for (std::size_t lane = 0; lane < count; ++lane) {
      const TissueCell& cell = *some[lane];
      const double area = cell.area, seen = area * static_cast<double>(samples[lane].visible);
      sums.all += area;
      if (!(seen > 0)) continue;
      sums.seen += seen;
      sums.greys.add(cell.first, cell.second, cell.share,
                     per_far * static_cast<double>(std::sqrt(squares[lane])), samples[lane].grey,
                     seen);
    }
    count = 0;
  };
  for (const TissueCell& cell : cells) {
    if (!(cell.area > 0)) continue;
    some[count++] = &cell;
    if (count == kFloatLanes) add();
  }
  if (count > 0) add();
}

double cellsPerArea(const ModelLoop& model) {
  const std::vector<TissueCell>& cells = model.frames.front().cells;
  const TissueCell &a = cells[0], &b = cells[1],
                   &c = cells[static_cast<std::size_t>(model.cells_along)];
  const double along = std::hypot(b.x_m - a.x_m, b.z_m - a.z_m),
               turn = std::abs(std::atan2(a.x_m, a.z_m) - std::atan2(c.x_m, c.z_m));
  return 1 / (along * turn * model.far_m);
}

echo::BeatPlace placeOf(const ModelLoop& model, std::size_t frame, const FitPose& pose,
                        const echo::EchoStack& real) {
  const int n = real.pictures();
  const double frames = static_cast<double>(model.frames.size()),
               to = pose.systole > 0 ? pose.systole : real.systole();
  const auto placed = [&](double f) {
    return n * echo::warpedPhase(f / frames, model.systole, to);
  };
  const double here = placed(static_cast<double>(frame)) + pose.lag;
  echo::BeatPlace out;
  out.pace = placed(static_cast<double>(frame) + 1) + pose.lag - here;
  const auto fill = [&](double first, std::initializer_list<double> shares) {
    int at = static_cast<int>(first) % n, i = 0;
    if (at < 0) at += n;
    for (const double share : shares) {
      out.pictures[i] = at;
      out.shares[i++] = static_cast<float>(share);
      at = at + 1 == n ? 0 : at + 1;
    }
  };
  if (pose.systole > 0) {
    // For a search: the quadratic B-spline. The mean of two pictures has half the speckle of one,
    // so linear blends would win; these have nearly equal speckle at any fraction.
    const double middle = std::round(here), t = here - middle;
    fill(middle - 1, {0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)});
    return out;
  }
  // A position that is a whole picture within rounding is not blended.
  constexpr double kRounding = 1e-6;
  const double whole = std::floor(here + kRounding), share = here - whole;
  if (share > kRounding)
    fill(whole, {1 - share, share});
  else
    fill(whole, {1});
  return out;
}

}  // namespace echocine::fit
