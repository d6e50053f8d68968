#include "echo/echo_stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "core/shown_path.h"
#include "echo/beam_grid.h"
#include "echo/frame_blend.h"
#include "metrics/block_match.h"

namespace echocine::echo {

namespace {

// Blocks of 9 mm are moved by up to 6 mm: a wall's thickness, and its way within a twentieth of a
// beat. Our choice.
constexpr BlockMatchSettings kBlock{4, 4, 6, 6};

cv::Mat header(const std::vector<float>& plane, int width, int height) {
  return {height, width, CV_32F, const_cast<float*>(plane.data())};
}

// Smoothed within the mask alone: the sector's border makes no edge.
std::vector<float> smoothed(const std::vector<float>& plane, const cv::Mat& mask, double sigma_px) {
  cv::Mat sum = header(plane, mask.cols, mask.rows).mul(mask), share;
  cv::GaussianBlur(sum, sum, {0, 0}, sigma_px, sigma_px, cv::BORDER_CONSTANT);
  cv::GaussianBlur(mask, share, {0, 0}, sigma_px, sigma_px, cv::BORDER_CONSTANT);
  sum /= cv::max(share, 1e-6);
  return {sum.ptr<float>(), sum.ptr<float>() + sum.total()};
}

// 0 on the border and outside, 1 from two standard deviations inside.
std::vector<float> softened(const cv::Mat& mask, double sigma_px) {
  cv::Mat share;
  cv::GaussianBlur(mask, share, {0, 0}, sigma_px, sigma_px, cv::BORDER_CONSTANT);
  share = cv::min(cv::max(2.1 * share - 1.05, 0.0), 1.0);
  return {share.ptr<float>(), share.ptr<float>() + share.total()};
}

std::vector<EchoStack::Sample> withGradients(const std::vector<float>& g,
                                             const std::vector<float>& visible, int width,
                                             int height) {
  std::vector<EchoStack::Sample> out(g.size());
  constexpr float kPerMillimetre = static_cast<float>(0.5e-3 / kEchoPixel_m);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i) {
      const auto at = static_cast<std::ptrdiff_t>(j) * width + i;
      const float* p = g.data() + at;
      EchoStack::Sample& s = out[static_cast<std::size_t>(at)];
      s.grey = *p;
      s.visible = visible[static_cast<std::size_t>(at)];
      if (i > 0 && i + 1 < width) s.gx = kPerMillimetre * (p[1] - p[-1]);
      if (j > 0 && j + 1 < height) s.gz = kPerMillimetre * (p[width] - p[-width]);
    }
  return out;
}

}  // namespace

EchoStack::EchoStack(const EchoLoop& real, const BeatSpan& beat, int pictures, double depth_m) {
  if (real.video.frameCount() < 0.5 * beat.frames)
    throw SceneError(fmt::format(
        "{}: {} frames are less than half of its beat of {:.1f} frames; give a longer loop",
        shownName(real.video.name), real.video.frameCount(), beat.frames));
  metres_per_pixel_ =
      real.metres_per_pixel ? *real.metres_per_pixel : depth_m / real.sector().r_max;
  far_m_ = metres_per_pixel_ * real.sector().r_max;
  spread_ = measureSpread(real, metres_per_pixel_);
  systole_ = beat.systole > 0 ? beat.shown_systole : 0;
  const double per_pixel = metres_per_pixel_ / kEchoPixel_m;
  width_ = static_cast<int>(std::ceil(real.video.width * per_pixel));
  height_ = static_cast<int>(std::ceil(real.video.height * per_pixel));
  origin_x_ = real.sector().apex_x * per_pixel;
  origin_z_ = real.sector().apex_y * per_pixel;
  planes_.resize(static_cast<std::size_t>(pictures));
  sharp_.resize(planes_.size());
  motion_.resize(planes_.size());
  markInside(real);
  makePictures(real, beat);
  measureEdges();
  blocks_across_ = width_ / kBlockStep + 1;
  blocks_down_ = height_ / kBlockStep + 1;
  parallelBlocks(planes_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) trackOne(n);
  });
  sharp_.clear();
}

void EchoStack::markInside(const EchoLoop& real) {
  inside_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  const double per_pixel = metres_per_pixel_ / kEchoPixel_m;
  const Video& v = real.video;
  for (int j = 0; j < height_; ++j)
    for (int i = 0; i < width_; ++i) {
      const double x = (i + 0.5) / per_pixel, y = (j + 0.5) / per_pixel;
      if (!(x < v.width && y < v.height && real.sector().contains(x, y))) continue;
      const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(v.width) +
                      static_cast<std::size_t>(x);
      inside_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
              static_cast<std::size_t>(i)] = real.overlay.empty() || real.overlay[at] == 0 ? 1 : 0;
    }
}

namespace {

// Where a picture of the beat stands in the loop: in the beat itself, or where that is cut off, a
// beat earlier. Negative: the loop does not show it.
double placeOf(const BeatSpan& beat, double phase, int frames) {
  double place =
      beat.end_diastole + warpedPhase(phase, beat.shown_systole, beat.systole) * beat.frames;
  while (place > frames - 1) place -= beat.frames;
  return place;
}

// Where the last frame stands a beat before the first: next to it, where the loop closes.
double placeBefore(const BeatSpan& beat, int frames) {
  return frames - 1 - beat.frames;
}
bool shows(const BeatSpan& beat, double place, int frames) {
  const double before = placeBefore(beat, frames);
  return place >= 0 || (place >= before && before > -1.01);
}

// One frame of the loop, or two blended, on the stack's pixels.
cv::Mat pictureAt(const Video& v, const BeatSpan& beat, double place, int width, int height) {
  Blend blend = blendAt(std::max(0.0, place), v.frameCount(), 0, false);
  if (place < 0) {
    const double before = placeBefore(beat, v.frameCount());
    blend.a = v.frames.size() - 1, blend.b = 0;
    blend.share = static_cast<decltype(blend.share)>((place - before) / -before);
  }
  const auto bytes = [&](std::size_t f) {
    return cv::Mat(v.height, v.width, CV_8U, const_cast<std::uint8_t*>(v.frames[f].data()));
  };
  cv::Mat full, out;
  cv::addWeighted(bytes(blend.a), 1 - blend.share, bytes(blend.b), blend.share, 0, full, CV_32F);
  // The mean over each pixel's area where the video is the finer one.
  cv::resize(full, out, {width, height}, 0, 0, v.width > width ? cv::INTER_AREA : cv::INTER_LINEAR);
  return out;
}

}  // namespace

void EchoStack::makePictures(const EchoLoop& real, const BeatSpan& beat) {
  cv::Mat mask(height_, width_, CV_32F);
  for (int j = 0; j < height_; ++j)
    for (int i = 0; i < width_; ++i)
      mask.at<float>(j, i) =
          inside_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(i)];
  constexpr double kSigma_px = kEchoSmoothing_m / kEchoPixel_m;
  const std::vector<float> visible = softened(mask, kSigma_px);
  parallelBlocks(planes_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const double place =
          placeOf(beat, static_cast<double>(n) / static_cast<double>(planes_.size()),
                  real.video.frameCount());
      if (!shows(beat, place, real.video.frameCount())) continue;
      const cv::Mat picture = pictureAt(real.video, beat, place, width_, height_);
      sharp_[n].assign(picture.ptr<float>(), picture.ptr<float>() + picture.total());
      planes_[n] = withGradients(smoothed(sharp_[n], mask, kSigma_px), visible, width_, height_);
    }
  });
}

void EchoStack::measureEdges() {
  double sum = 0, n = 0;
  for (const std::vector<Sample>& plane : planes_)
    for (std::size_t i = 0; i < plane.size(); ++i)
      if (inside_[i] != 0) {
        sum += static_cast<double>(plane[i].gx) * plane[i].gx +
               static_cast<double>(plane[i].gz) * plane[i].gz;
        ++n;
      }
  edge_scale_ = n > 0 ? std::max(1e-3, std::sqrt(sum / n)) : 1;
}

void EchoStack::trackOne(std::size_t picture) {
  const std::size_t next = (picture + 1) % planes_.size();
  if (sharp_[picture].empty() || sharp_[next].empty()) return;
  const BlockPlane before{sharp_[picture], height_, width_}, after{sharp_[next], height_, width_};
  motion_[picture].resize(static_cast<std::size_t>(blocks_across_) *
                          static_cast<std::size_t>(blocks_down_));
  for (int b = 0; b < blocks_down_; ++b)
    for (int a = 0; a < blocks_across_; ++a) {
      const int i = a * kBlockStep, j = b * kBlockStep;
      if (i >= width_ || j >= height_ ||
          inside_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(i)] == 0)
        continue;
      const auto found = matchBlock(before, after, j, i, kBlock);
      if (!found) continue;
      motion_[picture][static_cast<std::size_t>(b) * static_cast<std::size_t>(blocks_across_) +
                       static_cast<std::size_t>(a)] = {
          static_cast<float>(found->samples * kEchoPixel_m),
          static_cast<float>(found->lines * kEchoPixel_m),
          static_cast<float>(std::clamp(found->correlation, 0.0, 1.0))};
    }
}

}  // namespace echocine::echo
