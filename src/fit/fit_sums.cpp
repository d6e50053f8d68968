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

double seenBeside(const BoundaryPoint& p, const echo::EchoStack& real, const PoseMapping& map,
                  double x, double z, double nx, double nz) {
  const double r = std::sqrt(x * x + z * z);
  if (!p.of_blood || !(r > 0) || real.spread().patches == 0) return 0;
  return real.spread().shift(r, (nx * x + nz * z) / r) +
         static_cast<double>(p.inside_m) * map.scale();
}

namespace {

// Places where four boundary points are visible, and their normals.
struct FourEdges {
  Doubles4 x{}, z{}, nx{}, nz{};
  Mask4 of_blood{};
};

// Gradients out of blood, or their magnitudes. The sector's end shows no edge.
Doubles4 edgesOf(const FourEdges& four, Doubles4 gx, Doubles4 gz, Doubles4 visible) {
  const Doubles4 edge = (four.nx * gx + four.nz * gz) * visible;
  return four.of_blood ? edge : magnitude(edge);
}

// Samples at the far end of the profiles, in double precision.
echo::SampleLanes farEndsOf(std::size_t count, const FourEdges halves[2],
                            const echo::EchoInstant& at) {
  echo::SampleLanes out{};
  for (std::size_t i = 0; i < count; ++i) {
    const FourEdges& four = halves[i / kDoubleLanes];
    const std::size_t lane = i % kDoubleLanes;
    const echo::EchoStack::Sample g = at.at(four.x[lane] + kProfileReach_m * four.nx[lane],
                                            four.z[lane] + kProfileReach_m * four.nz[lane]);
    out.gx[i] = g.gx, out.gz[i] = g.gz, out.visible[i] = g.visible;
  }
  return out;
}

// e: e^(2 e(s)/E) of Eq. 4, by step. Precondition: all are positive.
void fillProfiles(const Doubles4 e[kProfileSteps], PlacedEdge out[kDoubleLanes]) {
  Doubles4 sum{}, mean{}, square{};
  for (int i = 0; i < kProfileSteps; ++i) sum += e[i];
  for (int i = 0; i < kProfileSteps; ++i) {
    const Doubles4 p = e[i] / sum;
    const double t = 2.0 * i / (kProfileSteps - 1) - 1;
    mean += p * t * kProfileReach_m;
    square += p * t * t;
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) out[lane].edge.p[i] = p[lane];
  }
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane)
    out[lane].edge.mean_m = mean[lane], out[lane].edge.square = square[lane];
}

}  // namespace

void placedEdges(std::span<const BoundaryPoint> points, const echo::EchoInstant& at,
                 const PoseMapping& map, PlacedEdge out[kFloatLanes]) {
  FourEdges halves[2];
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BoundaryPoint& p = points[i];
    PlacedEdge& o = out[i];
    map.place(p.x_m, p.z_m, o.x, o.z);
    map.turn(p.nx, p.nz, o.nx, o.nz);
    o.beside = seenBeside(p, at.stack(), map, o.x, o.z, o.nx, o.nz);
    FourEdges& four = halves[i / kDoubleLanes];
    const std::size_t lane = i % kDoubleLanes;
    four.x[lane] = o.x - o.beside * o.nx, four.z[lane] = o.z - o.beside * o.nz;
    four.nx[lane] = o.nx, four.nz[lane] = o.nz;
    four.of_blood[lane] = p.of_blood ? -1 : 0;
  }
  const auto& [low, high] = halves;
  const double per_scale = kSharpness / at.stack().edgeScale();
  constexpr auto kReach = static_cast<float>(kProfileReach_m);
  const Floats8 x = joined(low.x, high.x), z = joined(low.z, high.z),
                along_x = joined(low.nx, high.nx) * kReach,
                along_z = joined(low.nz, high.nz) * kReach;
  Doubles4 e[2][kProfileSteps];
  for (int i = 0; i < kProfileSteps; ++i) {
    const float t = 2.0f * static_cast<float>(i) / (kProfileSteps - 1) - 1;
    const echo::SampleLanes g = i + 1 < kProfileSteps ? at.at(x + along_x * t, z + along_z * t)
                                                      : farEndsOf(points.size(), halves, at);
    const Floats8 scaled = exponential(
        joined(per_scale * edgesOf(low, lowHalf(g.gx), lowHalf(g.gz), lowHalf(g.visible)),
               per_scale * edgesOf(high, highHalf(g.gx), highHalf(g.gz), highHalf(g.visible))));
    e[0][i] = lowHalf(scaled), e[1][i] = highHalf(scaled);
    if (i == kProfileSteps / 2)
      for (std::size_t lane = 0; lane < kFloatLanes; ++lane)
        out[lane].edge.visible = g.visible[lane];
  }
  fillProfiles(e[0], out);
  fillProfiles(e[1], out + kDoubleLanes);
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
    const echo::SampleLanes samples = at.at(x, z);
    const Floats8 squares = x * x + z * z;
    const double per_far = 1 / at.stack().far();
    for (std::size_t lane = 0; lane < count; ++lane) {
      const TissueCell& cell = *some[lane];
      const double area = cell.area, seen = area * static_cast<double>(samples.visible[lane]);
      sums.all += area;
      if (!(seen > 0)) continue;
      sums.seen += seen;
      sums.greys.add(cell.first, cell.second, cell.share,
                     per_far * static_cast<double>(std::sqrt(squares[lane])), samples.grey[lane],
                     seen, cell.expected);
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
