#include "truth/visible_border.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>

#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Levels of a frame about a point of a contour.
struct Levels {
  const Probe& probe;
  const ScanGeometry& geometry;
  std::span<const float> greys;
  Vec3d point_m;
  double place = geometry.placeOf(point_m);

  // The level of the nearest sample; none outside the scan area.
  std::optional<double> at(Vec3d p) const {
    const auto beam = geometry.beamPositionBeside(point_m, place, p);
    if (!beam || beam->path_m < probe.min_depth_m || beam->path_m > probe.max_depth_m) return {};
    const double sample = (beam->path_m - probe.min_depth_m) / probe.sampleSpacing() - 0.5;
    const auto line = static_cast<std::size_t>(geometry.nearestLine(beam->line));
    const auto k =
        static_cast<std::size_t>(std::clamp(static_cast<int>(sample + 0.5), 0, probe.samples - 1));
    return static_cast<double>(greys[line * static_cast<std::size_t>(probe.samples) + k]);
  }

  // Mean over 6 mm along the tangent, at offsets along the normal; none if half of it is outside.
  std::optional<double> mean(Vec3d tangent, Vec3d normal,
                             std::initializer_list<double> offsets_m) const {
    double sum = 0;
    int inside = 0, all = 0;
    for (const double across_m : offsets_m)
      for (int i = -3; i <= 3; ++i) {
        ++all;
        if (const auto level = at(point_m + 1e-3 * i * tangent + across_m * normal))
          sum += *level, ++inside;
      }
    if (2 * inside < all) return {};
    return sum / inside;
  }
};

// Twice the enclosed area in the plane of x and z; positive if the outside lies along (t_z, -t_x)
// of a tangent t.
double turnOf(const std::vector<Vec3d>& points) {
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3d a = points[i], b = points[(i + 1) % points.size()];
    sum += a.x * b.z - a.z * b.x;
  }
  return sum;
}

// The place on the contour `reach_m` ahead of point i (behind it if `step` is -1), or its end.
Vec3d placeAlong(const Contour& contour, std::size_t i, int step, double reach_m) {
  const auto count = static_cast<std::ptrdiff_t>(contour.points_m.size());
  auto at = static_cast<std::ptrdiff_t>(i);
  double gone_m = 0;
  for (std::ptrdiff_t n = 1; n < count && gone_m < reach_m; ++n) {
    std::ptrdiff_t next = at + step;
    if (contour.closed) next = (next + count) % count;
    if (next < 0 || next >= count) break;
    gone_m += length(contour.points_m[static_cast<std::size_t>(next)] -
                     contour.points_m[static_cast<std::size_t>(at)]);
    at = next;
  }
  return contour.points_m[static_cast<std::size_t>(at)];
}

}  // namespace

std::vector<char> visiblePoints(const Contour& contour, bool membrane, const Probe& probe,
                                std::span<const float> greys, double range_db) {
  const ScanGeometry geometry(probe);
  const double turn = turnOf(contour.points_m) > 0 ? 1 : -1;
  const double least = kVisibleStep_dB / range_db;
  std::vector<char> visible(contour.points_m.size(), 0);
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const Levels levels{probe, geometry, greys, contour.points_m[i]};
    constexpr double kHalfChord_m = 2e-3;
    const Vec3d chord =
        placeAlong(contour, i, 1, kHalfChord_m) - placeAlong(contour, i, -1, kHalfChord_m);
    if (length(chord) < 1e-9 || !levels.at(contour.points_m[i])) continue;
    const Vec3d tangent = normalised(chord);
    const Vec3d outside = turn * Vec3d{tangent.z, 0, -tangent.x};
    const auto inner = levels.mean(tangent, outside, {-1e-3, -2e-3, -3e-3});
    if (!membrane) {
      const auto outer = levels.mean(tangent, outside, {0.75e-3, 1.5e-3, 2.25e-3});
      visible[i] = inner && outer && std::abs(*outer - *inner) >= least;
    } else {
      const auto outer = levels.mean(tangent, outside, {1e-3, 2e-3, 3e-3});
      const auto sheet = levels.mean(tangent, outside, {-0.25e-3, 0, 0.25e-3});
      visible[i] = inner && outer && sheet && *sheet - std::max(*inner, *outer) >= least;
    }
  }
  return visible;
}

}  // namespace echocine
