#include "echo/beam_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace echocine::echo {

namespace {

// An interval of angles (rad) or of depths (m, or parts of the outer radius).
struct Span {
  double lo, hi;
  double length() const { return hi - lo; }
};

[[noreturn]] void noOverlap(const EchoLoop& synthetic, const EchoLoop& real, const char* what,
                            Span s, Span r, const char* unit) {
  throw SceneError(
      fmt::format("{} and {} do not overlap: {} {:.0f} to {:.0f} {} against {:.0f} to {:.0f}; give "
                  "loops of the "
                  "same view, or the right --scale and --sector",
                  synthetic.video.name, real.video.name, what, s.lo, s.hi, unit, r.lo, r.hi));
}

// Near the edges of a sector a pixel is partly black.
constexpr double kEdgePx = 1.5;

}  // namespace

// Without a length scale on both sides depths can only be compared as parts of each sector's own
// radius.
BeamGrid commonGrid(const EchoLoop& synthetic, const EchoLoop& real) {
  BeamGrid grid;
  grid.metric = synthetic.metres_per_pixel && real.metres_per_pixel;
  const auto angles = [](const EchoLoop& l) {
    return Span{l.sector().first_rad, l.sector().last_rad};
  };
  const auto depths = [&](const EchoLoop& l) {
    const double unit = grid.metric ? *l.metres_per_pixel : 1 / l.sector().r_max;
    return Span{l.sector().r_min * unit, l.sector().r_max * unit};
  };
  const Span a = angles(synthetic), b = angles(real), p = depths(synthetic), q = depths(real);
  grid.first_rad = std::max(a.lo, b.lo);
  grid.last_rad = std::min(a.hi, b.hi);
  grid.near = std::max(p.lo, q.lo);
  grid.far = std::min(p.hi, q.hi);
  // A third: less than that cannot be a view of the same thing. Our choice.
  if (grid.last_rad - grid.first_rad < std::min(a.length(), b.length()) / 3)
    noOverlap(synthetic, real, "angles", {degreesFromRadians(a.lo), degreesFromRadians(a.hi)},
              {degreesFromRadians(b.lo), degreesFromRadians(b.hi)}, "degrees");
  if (grid.far - grid.near < std::min(p.length(), q.length()) / 3)
    noOverlap(synthetic, real, "depths", {1e3 * p.lo, 1e3 * p.hi}, {1e3 * q.lo, 1e3 * q.hi},
              grid.metric ? "mm" : "thousandths");
  // As many samples as the coarser picture has pixels along a line: more would only repeat it.
  const double pixels =
      (grid.far - grid.near) * std::min(pixelsPerUnit(grid, synthetic), pixelsPerUnit(grid, real));
  grid.samples = static_cast<int>(std::clamp(pixels, 64.0, 384.0));
  // As far apart across as along, at half the depth.
  const double across = (grid.last_rad - grid.first_rad) * (grid.near + grid.far) / 2 /
                        (grid.far - grid.near) * grid.samples;
  grid.lines = static_cast<int>(std::clamp(across, 32.0, 384.0));
  return grid;
}

double pixelsPerUnit(const BeamGrid& grid, const EchoLoop& loop) {
  return grid.metric ? 1 / *loop.metres_per_pixel : loop.sector().r_max;
}

// Angles count from straight down, towards +x; y runs downwards.
PicturePoint pictureAt(const BeamGrid& grid, const EchoLoop& loop, const Placement& placement,
                       double angle_rad, double depth) {
  const double r = placement.scale * depth * pixelsPerUnit(grid, loop);
  const double angle = angle_rad + placement.rotation_rad;
  return {loop.sector().apex_x + placement.shift_x_px + r * std::sin(angle),
          loop.sector().apex_y + placement.shift_y_px + r * std::cos(angle)};
}

// The sector is narrowed by the same length at its arcs and at its sides, where that is an angle
// that grows towards the apex.
bool showsEcho(const EchoLoop& loop, double x, double y) {
  const Video& v = loop.video;
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  if (i < 0 || j < 0 || i >= v.width || j >= v.height) return false;
  if (loop.overlay[static_cast<std::size_t>(j) * static_cast<std::size_t>(v.width) +
                   static_cast<std::size_t>(i)] != 0)
    return false;
  Sector inner = loop.sector();
  const double inset = kEdgePx / std::max(kEdgePx, std::hypot(x - inner.apex_x, y - inner.apex_y));
  inner.r_min += kEdgePx;
  inner.r_max -= kEdgePx;
  inner.first_rad += inset;
  inner.last_rad -= inset;
  return inner.contains(x, y);
}

PixelPlane validSamples(const BeamGrid& grid, const EchoLoop& loop, const Placement& placement) {
  PixelPlane valid;
  valid.reserve(grid.size());
  for (int i = 0; i < grid.lines; ++i)
    for (int k = 0; k < grid.samples; ++k) {
      const PicturePoint p = pictureAt(grid, loop, placement, grid.angle(i), grid.depth(k));
      valid.push_back(showsEcho(loop, p.x, p.y) ? 1 : 0);
    }
  return valid;
}

// A sample's area in the picture grows with its depth; over the outer depth it is 1 at most.
std::vector<float> areaWeights(const BeamGrid& grid, const PixelPlane& a, const PixelPlane& b) {
  std::vector<float> weights(grid.size(), 0);
  for (int i = 0; i < grid.lines; ++i)
    for (int k = 0; k < grid.samples; ++k) {
      const std::size_t at = static_cast<std::size_t>(i) * static_cast<std::size_t>(grid.samples) +
                             static_cast<std::size_t>(k);
      if (a[at] != 0 && b[at] != 0) weights[at] = static_cast<float>(grid.depth(k) / grid.far);
    }
  return weights;
}

}  // namespace echocine::echo
