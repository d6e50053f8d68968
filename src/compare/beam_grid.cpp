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

// An interval of angles (rad) or of depths (m, or parts of the outer radius).
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

// Without a length scale on both sides depths can only be compared as parts of each sector's own
// radius.
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

double pixelsPerUnit(const BeamGrid& grid, const Loop& loop) {
  return grid.metric ? 1 / *loop.metres_per_pixel : loop.sector().r_max;
}

// Angles count from straight down, towards +x; y runs downwards.
PicturePoint pictureAt(const BeamGrid& grid, const Loop& loop, const Placement& placement,
                       double angle_rad, double depth) {
  const double r = placement.scale * depth * pixelsPerUnit(grid, loop);
  const double angle = angle_rad + placement.rotation_rad;
  return {loop.sector().apex_x + placement.shift_x_px + r * std::sin(angle),
          loop.sector().apex_y + placement.shift_y_px + r * std::cos(angle)};
}

// The sector is narrowed by the same length at its arcs and at its sides, where that is an angle
// that grows towards the apex.
PixelPlane validSamples(const BeamGrid& grid, const Loop& loop, const Placement& placement) {
  const Video& v = loop.video;
  Sector inner = loop.sector();
  inner.r_min += kEdgePx;
  inner.r_max -= kEdgePx;
  PixelPlane valid;
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

namespace {

// Greys that are in beam space already: a picture of their own, x the sample, y the line.
void resampleTraced(const BeamGrid& grid, const Loop& loop, const Placement& placement,
                    BeamLoop& out) {
  const TracedGreys& t = loop.traced;
  // Pixels of that picture: lines stand at whole numbers, samples at halves, as in an EXR.
  const double sample_m = (t.far_m - t.near_m) / t.samples,
               line_rad = (t.last_rad - t.first_rad) / (t.lines - 1);
  std::vector<PixelPlace> places;
  places.reserve(grid.size());
  for (int i = 0; i < grid.lines; ++i)
    for (int k = 0; k < grid.samples; ++k) {
      const PicturePoint p = pictureAt(grid, loop, placement, grid.angle(i), grid.depth(k));
      const double dx = p.x - loop.sector().apex_x, dy = p.y - loop.sector().apex_y;
      const double depth_m = std::hypot(dx, dy) * *loop.metres_per_pixel;
      places.push_back(pixelPlace(t.samples, t.lines, (depth_m - t.near_m) / sample_m,
                                  (std::atan2(dx, dy) - t.first_rad) / line_rad + 0.5));
    }
  // Finer than the grid: smoothed to its spacing, as pictures are.
  const auto sigma = [](double ratio) {
    return ratio > 1 ? 0.5 * std::sqrt(ratio * ratio - 1) : 0.0;
  };
  const double along = sigma((grid.far - grid.near) / grid.samples * pixelsPerUnit(grid, loop) *
                             *loop.metres_per_pixel / sample_m),
               across =
                   sigma((grid.last_rad - grid.first_rad) / std::max(1, grid.lines - 1) / line_rad);
  constexpr double kLeast = 1e-3;  // a Gaussian of no width is none
  out.frames.resize(t.frames.size());
  parallelBlocks(t.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      cv::Mat greys(t.lines, t.samples, CV_32F, const_cast<float*>(t.frames[f].data()));
      if (along > kLeast || across > kLeast) {
        cv::Mat smooth;
        cv::GaussianBlur(greys, smooth, {0, 0}, std::max(along, kLeast), std::max(across, kLeast));
        greys = smooth;
      }
      std::vector<float>& frame = out.frames[f];
      frame.reserve(places.size());
      for (const PixelPlace& place : places)
        frame.push_back(greyAt(greys.ptr<float>(), t.samples, place));
    }
  });
}

}  // namespace

BeamLoop resample(const BeamGrid& grid, const Loop& loop, const Placement& placement) {
  const Video& v = loop.video;
  BeamLoop out;
  out.valid = validSamples(grid, loop, placement);
  if (!loop.traced.frames.empty()) {
    resampleTraced(grid, loop, placement, out);
    return out;
  }
  std::vector<PixelPlace> places;
  places.reserve(grid.size());
  for (int i = 0; i < grid.lines; ++i)
    for (int k = 0; k < grid.samples; ++k) {
      const PicturePoint p = pictureAt(grid, loop, placement, grid.angle(i), grid.depth(k));
      places.push_back(pixelPlace(v.width, v.height, p.x, p.y));
    }
  // A Gaussian of half the spacing is what the coarser raster can hold; the pixel itself has half a
  // pixel of it already, and variances subtract.
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
      frame.reserve(places.size());
      for (const PixelPlace& place : places)
        frame.push_back(greyAt(grey.ptr<float>(), v.width, place));
    }
  });
  return out;
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

}  // namespace echocine::compare
