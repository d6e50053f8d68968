#pragma once
// The floors of the signal stage: running sums both ways, logarithm by OpenCV, and a sparse table
// from beam space to pixels.

#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "bench/bench_scene.h"
#include "scene/scan_geometry.h"
#include "signal/beam_width.h"
#include "signal/scan_conversion.h"

namespace echocine::bench {

// The average over the beam and the pulse with windows of whole samples and lines, in single
// precision: the few taps of the pulse added up along each line, then across the lines a sum that
// one line enters and one leaves, for 128 depths at a time.
class BareAverage {
 public:
  explicit BareAverage(const Scene& scene)
      : lines_(static_cast<std::size_t>(scene.probe.lines)),
        samples_(static_cast<std::size_t>(scene.probe.samples)),
        line_(samples_),
        out_(lines_ * samples_) {
    const Probe& p = scene.probe;
    const double wavelength_m = kScannerSpeed / p.frequency_hz;
    const double pulse_m = scene.signal.pulse_cycles * wavelength_m / 2;
    taps_ = 2 * static_cast<std::size_t>(std::lround((pulse_m / p.sampleSpacing() - 1) / 2)) + 1;
    for (int k = 0; k < p.samples; ++k) {
      const double depth_m = p.min_depth_m + (k + 0.5) * p.sampleSpacing();
      const double width_m = focusedBeamWidth(depth_m, p.aperture_m, p.focus_m, wavelength_m);
      const double reach = (width_m / lineSpacing(p, depth_m) - 1) / 2;
      reach_.push_back(static_cast<std::size_t>(std::lround(std::max(reach, 0.0))));
    }
  }

  // Samples are a multiple of 128.
  void run(std::vector<float>& plane) {
    for (std::size_t i = 0; i < lines_; ++i) along(plane.data() + i * samples_);
    for (std::size_t k = 0; k < samples_; k += kBlock) across(plane.data() + k, out_.data() + k, k);
    plane.swap(out_);
  }

 private:
  static constexpr std::size_t kBlock = 128;
  using Eight = float __attribute__((vector_size(32)));
  static Eight at(const float* from) {
    Eight eight;
    __builtin_memcpy(&eight, from, sizeof eight);
    return eight;
  }

  void along(float* line) {
    std::copy_n(line, samples_, line_.data());
    const float scale = 1 / static_cast<float>(taps_);
    for (std::size_t k = 0; k + taps_ + 8 <= samples_; k += 8) {
      Eight sum = at(line_.data() + k);
      for (std::size_t j = 1; j < taps_; ++j) sum += at(line_.data() + k + j);
      sum *= scale;
      __builtin_memcpy(line + k + taps_ / 2, &sum, sizeof sum);
    }
  }

  // One window for the block, that of its first depth.
  void across(const float* in, float* out, std::size_t depth) {
    const std::size_t reach = reach_[depth];
    const float scale = 1 / static_cast<float>(2 * reach + 1);
    float sum[kBlock] = {};
    for (std::size_t i = 0; i < lines_ + reach; ++i) {
      const float* enters = in + std::min(i, lines_ - 1) * samples_;
      const float* leaves = in + (i > 2 * reach ? i - 2 * reach - 1 : 0) * samples_;
      float* mean = out + (i > reach ? i - reach : 0) * samples_;
      for (std::size_t s = 0; s < kBlock; s += 8) {
        const Eight next = at(sum + s) + at(enters + s) - at(leaves + s);
        const Eight scaled = next * scale;
        __builtin_memcpy(sum + s, &next, sizeof next);
        __builtin_memcpy(mean + s, &scaled, sizeof scaled);
      }
    }
  }

  std::size_t lines_, samples_, taps_ = 1;
  std::vector<float> line_, out_;
  std::vector<std::size_t> reach_;
};

// cv::log and one scaling that limits to 0..1.
class BareLog {
 public:
  void run(const std::vector<float>& plane, float reference, float range_db, cv::Mat& grey) {
    const cv::Mat in(1, static_cast<int>(plane.size()), CV_32F, const_cast<float*>(plane.data()));
    cv::log(in, log_);
    const double scale = 255 * 10 / std::log(10.0) / range_db;
    log_.convertTo(grey, CV_8U, scale, 255 - scale * std::log(reference));
  }

 private:
  cv::Mat log_;
};

// Four greys and their weights per pixel of the sector.
class BareScanConversion {
 public:
  BareScanConversion(const Scene& scene, const PictureGeometry& g)
      : samples_(static_cast<std::size_t>(scene.probe.samples)),
        picture_(static_cast<std::size_t>(scene.output.width) *
                 static_cast<std::size_t>(scene.output.height)) {
    const Probe& p = scene.probe;
    for (int y = 0; y < scene.output.height; ++y)
      for (int x = 0; x < scene.output.width; ++x) {
        const double at_x = (x + 0.5 - g.origin_x_px) * g.metres_per_pixel;
        const double at_z = (y + 0.5 - g.origin_y_px) * g.metres_per_pixel;
        const double line = (std::atan2(at_x, at_z) - p.first_angle_rad) * (p.lines - 1) /
                            (p.last_angle_rad - p.first_angle_rad);
        const double k = (std::hypot(at_x, at_z) - p.min_depth_m) / p.sampleSpacing() - 0.5;
        if (!(line >= 0 && line < p.lines - 1 && k >= 0 && k < p.samples - 1)) continue;
        const auto across = static_cast<float>(line - std::floor(line)),
                   along = static_cast<float>(k - std::floor(k));
        table_.push_back({static_cast<std::uint32_t>(y * scene.output.width + x),
                          static_cast<std::uint32_t>(std::floor(line) * p.samples + std::floor(k)),
                          {(1 - across) * (1 - along), (1 - across) * along, across * (1 - along),
                           across * along}});
      }
  }

  const std::vector<std::uint8_t>& run(const std::uint8_t* grey) {
    for (const Pixel& p : table_) {
      const std::uint8_t* left = grey + p.sample;
      const std::uint8_t* right = left + samples_;
      const float value = p.weight[0] * left[0] + p.weight[1] * left[1] + p.weight[2] * right[0] +
                          p.weight[3] * right[1];
      picture_[p.pixel] = static_cast<std::uint8_t>(value + 0.5f);
    }
    return picture_;
  }

 private:
  struct Pixel {
    std::uint32_t pixel, sample;
    float weight[4];
  };
  std::size_t samples_;
  std::vector<Pixel> table_;
  std::vector<std::uint8_t> picture_;
};

}  // namespace echocine::bench
