#include "compare/beam_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"

namespace echocine::compare {

namespace {

struct Span {
  double lo, hi;
  double length() const { return hi - lo; }
};

[[noreturn]] void noOverlap(const Loop& synthetic, const Loop& real, const char* what, Span s,
                            Span r, const char* unit) {
  throw SceneError(
      fmt::format("{} and {} do not overlap: {} {:.0f} to {:.0f} {} against {:.0f} to {:.0f}; give "
                  "loops of the "
                  "same view, or the right --scale and --sector",
                  synthetic.video.name, real.video.name, what, s.lo, s.hi, unit, r.lo, r.hi));
}

// Near the edges of a sector a pixel is partly black.
constexpr double kEdgePx = 1.5;

}  // namespace

BeamGrid commonGrid(const Loop& synthetic, const Loop& real) {
  BeamGrid grid;
  grid.metric = synthetic.metres_per_pixel && real.metres_per_pixel;
  const auto angles = [](const Loop& l) { return Span{l.sector().first_rad, l.sector().last_rad}; };
  const auto depths = [&](const Loop& l) {
    const double unit = grid.metric ? *l.metres_per_pixel : 1 / l.sector().r_max;
    return Span{l.sector().r_min * unit, l.sector().r_max * unit};
  };
  const Span a = angles(synthetic), b = angles(real), p = depths(synthetic), q = depths(real);
  grid.first_rad = std::max(a.lo, b.lo);
  grid.last_rad = std::min(a.hi, b.hi);
  grid.near = std::max(p.lo, q.lo);
  grid.far = std::min(p.hi, q.hi);
  if (grid.last_rad - grid.first_rad < std::min(a.length(), b.length()) / 3)
    noOverlap(synthetic, real, "angles", {degreesFromRadians(a.lo), degreesFromRadians(a.hi)},
              {degreesFromRadians(b.lo), degreesFromRadians(b.hi)}, "degrees");
  if (grid.far - grid.near < std::min(p.length(), q.length()) / 3)
    noOverlap(synthetic, real, "depths", {1e3 * p.lo, 1e3 * p.hi}, {1e3 * q.lo, 1e3 * q.hi},
              grid.metric ? "mm" : "thousandths");
  const double pixels =
      (grid.far - grid.near) * std::min(pixelsPerUnit(grid, synthetic), pixelsPerUnit(grid, real));
  grid.samples = static_cast<int>(std::clamp(pixels, 64.0, 384.0));
  // As far apart across as along, at half the depth.
  const double across = (grid.last_rad - grid.first_rad) * (grid.near + grid.far) / 2 /
                        (grid.far - grid.near) * grid.samples;
  grid.lines = static_cast<int>(std::clamp(across, 32.0, 384.0));
  return grid;
}

double pixelsPerUnit(const BeamGrid& grid, const Loop& loop) {
  return grid.metric ? 1 / *loop.metres_per_pixel : loop.sector().r_max;
}

PicturePoint pictureAt(const BeamGrid& grid, const Loop& loop, const Placement& placement,
                       double angle_rad, double depth) {
  const double r = placement.scale * depth * pixelsPerUnit(grid, loop);
  const double angle = angle_rad + placement.rotation_rad;
  return {loop.sector().apex_x + placement.shift_x_px + r * std::sin(angle),
          loop.sector().apex_y + placement.shift_y_px + r * std::cos(angle)};
}

float greyAt(const float* picture, int width, int height, double x, double y) {
  const double u = std::clamp(x - 0.5, 0.0, width - 1.0),
               v = std::clamp(y - 0.5, 0.0, height - 1.0);
  const int i = std::min(static_cast<int>(u), width - 2),
            j = std::min(static_cast<int>(v), height - 2);
  const auto fu = static_cast<float>(u - i), fv = static_cast<float>(v - j);
  const float* p = picture + static_cast<std::ptrdiff_t>(j) * width + i;
  return (1 - fv) * ((1 - fu) * p[0] + fu * p[1]) + fv * ((1 - fu) * p[width] + fu * p[width + 1]);
}

Plane validSamples(const BeamGrid& grid, const Loop& loop, const Placement& placement) {
  const Video& v = loop.video;
  Sector inner = loop.sector();
  inner.r_min += kEdgePx;
  inner.r_max -= kEdgePx;
  Plane valid;
  valid.reserve(grid.size());
  for (int i = 0; i < grid.lines; ++i)
    for (int k = 0; k < grid.samples; ++k) {
      const PicturePoint p = pictureAt(grid, loop, placement, grid.angle(i), grid.depth(k));
      const double inset =
          kEdgePx / std::max(kEdgePx, std::hypot(p.x - inner.apex_x, p.y - inner.apex_y));
      Sector narrowed = inner;
      narrowed.first_rad += inset;
      narrowed.last_rad -= inset;
      const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
      const bool inside =
          x >= 0 && y >= 0 && x < v.width && y < v.height && narrowed.contains(p.x, p.y) &&
          loop.overlay[static_cast<std::size_t>(y) * static_cast<std::size_t>(v.width) +
                       static_cast<std::size_t>(x)] == 0;
      valid.push_back(inside ? 1 : 0);
    }
  return valid;
}

BeamLoop resample(const BeamGrid& grid, const Loop& loop, const Placement& placement) {
  const Video& v = loop.video;
  BeamLoop out;
  out.valid = validSamples(grid, loop, placement);
  std::vector<PicturePoint> points;
  points.reserve(grid.size());
  for (int i = 0; i < grid.lines; ++i)
    for (int k = 0; k < grid.samples; ++k)
      points.push_back(pictureAt(grid, loop, placement, grid.angle(i), grid.depth(k)));
  const double spacing_px = (grid.far - grid.near) / grid.samples * pixelsPerUnit(grid, loop);
  const double sigma = spacing_px > 1 ? 0.5 * std::sqrt(spacing_px * spacing_px - 1) : 0;
  out.frames.resize(v.frames.size());
  parallelBlocks(v.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const cv::Mat bytes(v.height, v.width, CV_8U, const_cast<std::uint8_t*>(v.frames[f].data()));
      cv::Mat grey;
      bytes.convertTo(grey, CV_32F);
      if (sigma > 0) cv::GaussianBlur(grey, grey, {0, 0}, sigma);
      std::vector<float>& frame = out.frames[f];
      frame.reserve(points.size());
      for (const PicturePoint& p : points)
        frame.push_back(greyAt(grey.ptr<float>(), v.width, v.height, p.x, p.y));
    }
  });
  return out;
}

std::vector<float> areaWeights(const BeamGrid& grid, const Plane& a, const Plane& b) {
  std::vector<float> weights(grid.size(), 0);
  for (int i = 0; i < grid.lines; ++i)
    for (int k = 0; k < grid.samples; ++k) {
      const std::size_t at = static_cast<std::size_t>(i) * static_cast<std::size_t>(grid.samples) +
                             static_cast<std::size_t>(k);
      if (a[at] != 0 && b[at] != 0) weights[at] = static_cast<float>(grid.depth(k) / grid.far);
    }
  return weights;
}

}  // namespace echocine::compare
