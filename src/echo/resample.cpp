#include "echo/resample.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/parallel.h"

namespace echocine::echo {

namespace {

constexpr double kNoWidth = 1e-3;  // a Gaussian of no width is none

// The coarser raster can represent a Gaussian of half its spacing. A pixel of the finer one already
// has half a pixel of it, and variances subtract. In finer pixels; `ratio` finer pixels are one
// coarser pixel.
double smoothingFor(double ratio) {
  return ratio > 1 ? 0.5 * std::sqrt(ratio * ratio - 1) : 0;
}

// Traced greys are a picture of their own, x the sample, y the line: lines stand at whole numbers,
// samples at halves, as in an EXR.
double sampleLength(const TracedGreys& t) {
  return (t.far_m - t.near_m) / t.samples;
}
double lineAngle(const TracedGreys& t) {
  return (t.last_rad - t.first_rad) / (t.lines - 1);
}

}  // namespace

LoopSampler::LoopSampler(const BeamGrid& grid, const EchoLoop& loop)
    : grid_(grid), loop_(loop), traced_(!loop.traced.frames.empty()) {
  const double spacing_px = (grid.far - grid.near) / grid.samples * pixelsPerUnit(grid, loop);
  sigma_x_ = sigma_y_ = smoothingFor(spacing_px);
  if (!traced_) return;
  sigma_x_ = smoothingFor(spacing_px * *loop.metres_per_pixel / sampleLength(loop.traced));
  sigma_y_ = smoothingFor((grid.last_rad - grid.first_rad) / std::max(1, grid.lines - 1) /
                          lineAngle(loop.traced));
}

int LoopSampler::width() const {
  return traced_ ? loop_.traced.samples : loop_.video.width;
}

std::vector<float> LoopSampler::smoothed(std::vector<float> picture) const {
  if (sigma_x_ > kNoWidth || sigma_y_ > kNoWidth) {
    cv::Mat m(static_cast<int>(picture.size()) / width(), width(), CV_32F, picture.data());
    cv::GaussianBlur(m, m, {0, 0}, std::max(sigma_x_, kNoWidth), std::max(sigma_y_, kNoWidth));
  }
  return picture;
}

std::vector<float> LoopSampler::picture(std::size_t frame) const {
  if (traced_) return smoothed(loop_.traced.frames[frame]);
  const PixelPlane& bytes = loop_.video.frames[frame];
  return smoothed(std::vector<float>(bytes.begin(), bytes.end()));
}

std::vector<float> LoopSampler::meanPicture() const {
  return smoothed(traced_ ? meanOf(loop_.traced.frames) : meanOf(loop_.video.frames));
}

// pictureAt() for the whole grid.
template <typename AtPlace>
std::vector<PixelPlace> LoopSampler::everyPlace(const Placement& placement,
                                                const AtPlace& at) const {
  std::vector<PixelPlace> places;
  places.reserve(grid_.size());
  const double unit = placement.scale * pixelsPerUnit(grid_, loop_);
  for (int i = 0; i < grid_.lines; ++i) {
    const double angle = grid_.angle(i) + placement.rotation_rad, sine = std::sin(angle),
                 cosine = std::cos(angle);
    for (int k = 0; k < grid_.samples; ++k)
      places.push_back(at(placement.shift_x_px + unit * grid_.depth(k) * sine,
                          placement.shift_y_px + unit * grid_.depth(k) * cosine));
  }
  return places;
}

std::vector<PixelPlace> LoopSampler::placesInLoop(const Placement& placement) const {
  const Sector& sector = loop_.sector();
  return everyPlace(placement, [&](double dx, double dy) {
    return pixelPlace(loop_.video.width, loop_.video.height, sector.apex_x + dx,
                      sector.apex_y + dy);
  });
}

std::vector<PixelPlace> LoopSampler::places(const Placement& placement) const {
  if (!traced_) return placesInLoop(placement);
  const TracedGreys& t = loop_.traced;
  return everyPlace(placement, [&](double dx, double dy) {
    return pixelPlace(t.samples, t.lines,
                      (std::hypot(dx, dy) * *loop_.metres_per_pixel - t.near_m) / sampleLength(t),
                      (std::atan2(dx, dy) - t.first_rad) / lineAngle(t) + 0.5);
  });
}

BeamLoop resample(const BeamGrid& grid, const EchoLoop& loop, const Placement& placement) {
  const LoopSampler sampler(grid, loop);
  const std::vector<PixelPlace> places = sampler.places(placement);
  BeamLoop out;
  out.valid = validSamples(grid, loop, placement);
  out.frames.resize(loop.traced.frames.empty() ? loop.video.frames.size()
                                               : loop.traced.frames.size());
  parallelBlocks(out.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const std::vector<float> picture = sampler.picture(f);
      out.frames[f].reserve(places.size());
      for (const PixelPlace& place : places)
        out.frames[f].push_back(greyAt(picture.data(), sampler.width(), place));
    }
  });
  return out;
}

}  // namespace echocine::echo
