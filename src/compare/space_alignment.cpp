#include "compare/space_alignment.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/parallel.h"
#include "core/units.h"

namespace echocine::compare {

namespace {

constexpr int kMotionUnknowns = 6;  // shift x, shift y, scale, rotation; contrast, brightness

struct Level {
  std::vector<cv::Mat> real;       // smoothed pictures
  std::vector<cv::Mat> synthetic;  // smoothed frames in beam space
  int stride = 1;                  // of lines and samples: smooth greys need not all be looked at
};

// Both smoothed by about the same length: sigma in real pixels.
Level smoothed(const BeamGrid& grid, const Loop& real,
               const std::vector<std::vector<float>>& paired, const std::vector<int>& frames,
               double sigma_px) {
  Level level;
  const double sample_px = (grid.far - grid.near) / grid.samples * pixelsPerUnit(grid, real);
  const double line_px = (grid.last_rad - grid.first_rad) / std::max(1, grid.lines - 1) * 0.5 *
                         (grid.near + grid.far) * pixelsPerUnit(grid, real);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const cv::Mat bytes(
        real.video.height, real.video.width, CV_8U,
        const_cast<std::uint8_t*>(real.video.frames[static_cast<std::size_t>(frames[i])].data()));
    cv::Mat picture,
        beams =
            cv::Mat(grid.lines, grid.samples, CV_32F, const_cast<float*>(paired[i].data())).clone();
    bytes.convertTo(picture, CV_32F);
    if (sigma_px > 0) {
      cv::GaussianBlur(picture, picture, {0, 0}, sigma_px);
      cv::GaussianBlur(beams, beams, {0, 0}, std::max(0.3, sigma_px / sample_px),
                       std::max(0.3, sigma_px / line_px));
    }
    level.real.push_back(picture);
    level.synthetic.push_back(beams);
  }
  return level;
}

// Normal equations of the six unknowns, and the moments of which the correlation is made.
struct Sums {
  cv::Mat normal = cv::Mat::zeros(kMotionUnknowns, kMotionUnknowns, CV_64F),
          right = cv::Mat::zeros(kMotionUnknowns, 1, CV_64F);
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  double correlation() const {
    const double vx = xx - x * x / n, vy = yy - y * y / n;
    return n > 0 && vx > 0 && vy > 0 ? (xy - x * y / n) / std::sqrt(vx * vy) : 0;
  }
};

// What one line of beam space adds.
struct LineSums {
  double normal[kMotionUnknowns][kMotionUnknowns] = {}, right[kMotionUnknowns] = {};
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
};

// The real grey g at the placed point obeys g + grad g . dp = contrast * synthetic + brightness,
// with dp linear in the first four unknowns.
void addLine(const BeamGrid& grid, const Loop& real, const Level& level,
             const std::vector<float>& weights, const Placement& placement, int line, LineSums& s) {
  const int w = real.video.width, h = real.video.height;
  const double angle = grid.angle(line) + placement.rotation_rad;
  const double sine = std::sin(angle), cosine = std::cos(angle);
  for (int k = 0; k < grid.samples; k += level.stride) {
    const double weight =
        weights[static_cast<std::size_t>(line) * static_cast<std::size_t>(grid.samples) +
                static_cast<std::size_t>(k)];
    if (!(weight > 0)) continue;
    const double r = grid.depth(k) * pixelsPerUnit(grid, real), placed = placement.scale * r;
    const double x = real.sector().apex_x + placement.shift_x_px + placed * sine;
    const double y = real.sector().apex_y + placement.shift_y_px + placed * cosine;
    // Gradients need a pixel on each side.
    if (x < 1 || y < 1 || x > w - 1 || y > h - 1) continue;
    const PixelPlace here = pixelPlace(w, h, x, y), right = pixelPlace(w, h, x + 1, y),
                     left = pixelPlace(w, h, x - 1, y), below = pixelPlace(w, h, x, y + 1),
                     above = pixelPlace(w, h, x, y - 1);
    for (std::size_t f = 0; f < level.real.size(); ++f) {
      const float* picture = level.real[f].ptr<float>();
      const double g = greyAt(picture, w, here);
      const double gx = 0.5 * (greyAt(picture, w, right) - greyAt(picture, w, left));
      const double gy = 0.5 * (greyAt(picture, w, below) - greyAt(picture, w, above));
      const double v = level.synthetic[f].at<float>(line, k);
      s.n += weight, s.x += weight * v, s.y += weight * g;
      s.xx += weight * v * v, s.yy += weight * g * g, s.xy += weight * v * g;
      // d(g)/d(unknown): shifts move the point by 1 px, scale by r along the line, rotation by the
      // placed radius across it.
      const double row[kMotionUnknowns] = {
          -gx, -gy, -r * (gx * sine + gy * cosine), -placed * (gx * cosine - gy * sine), v, 1};
      for (int p = 0; p < kMotionUnknowns; ++p) {
        s.right[p] += weight * row[p] * g;
        for (int q = p; q < kMotionUnknowns; ++q) s.normal[p][q] += weight * row[p] * row[q];
      }
    }
  }
}

// Sums over all lines about a placement, line by line in order whatever the threads.
Sums sumsAt(const BeamGrid& grid, const Loop& real, const Level& level,
            const std::vector<float>& weights, const Placement& placement) {
  const auto lines = static_cast<std::size_t>((grid.lines + level.stride - 1) / level.stride);
  std::vector<LineSums> of_line(lines);
  parallelBlocks(lines, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      addLine(grid, real, level, weights, placement, static_cast<int>(i) * level.stride,
              of_line[i]);
  });
  Sums s;
  for (const LineSums& line : of_line) {
    s.n += line.n, s.x += line.x, s.y += line.y, s.xx += line.xx, s.yy += line.yy, s.xy += line.xy;
    for (int p = 0; p < kMotionUnknowns; ++p) {
      s.right.at<double>(p) += line.right[p];
      for (int q = 0; q < kMotionUnknowns; ++q)
        s.normal.at<double>(p, q) += line.normal[std::min(p, q)][std::max(p, q)];
    }
  }
  return s;
}

// 6 % of the radius, 6 % of scale, 6 degrees: what is left between loops of one view. Our choice.
bool withinLimits(const Placement& p, const Placement& start, double radius_px) {
  return std::hypot(p.shift_x_px - start.shift_x_px, p.shift_y_px - start.shift_y_px) <=
             0.06 * radius_px &&
         std::abs(p.scale - start.scale) <= 0.06 &&
         std::abs(p.rotation_rad - start.rotation_rad) <= radiansFromDegrees(6);
}

Placement improved(const Sums& sums, const Placement& from) {
  cv::Mat step;
  // SVD: a picture without edges in some direction leaves that unknown at 0 instead of failing.
  cv::solve(sums.normal, sums.right, step, cv::DECOMP_SVD);
  return {from.shift_x_px + step.at<double>(0), from.shift_y_px + step.at<double>(1),
          from.scale + step.at<double>(2), from.rotation_rad + step.at<double>(3)};
}

}  // namespace

SpaceAlignment alignInSpace(const BeamGrid& grid, const Loop& real,
                            const std::vector<std::vector<float>>& paired,
                            const std::vector<int>& real_frames, const std::vector<float>& weights,
                            const Placement& start) {
  SpaceAlignment out;
  Placement placement = start;
  double final_correlation = 0;
  const double finest =
      std::max(0.7, (grid.far - grid.near) / grid.samples * pixelsPerUnit(grid, real) / 2);
  // From coarse to fine: smooth greys catch large shifts, sharp ones are exact.
  for (const double sigma : {6 * finest, 3 * finest, 1.5 * finest, finest}) {
    Level level = smoothed(grid, real, paired, real_frames, sigma);
    level.stride = sigma > 2 * finest ? 3 : sigma > finest ? 2 : 1;
    Sums sums = sumsAt(grid, real, level, weights, placement);
    for (int i = 0; i < 12; ++i) {
      const Placement next = improved(sums, placement);
      if (!withinLimits(next, start, real.sector().r_max)) break;
      const Sums there = sumsAt(grid, real, level, weights, next);
      // A step that gains nothing is the end of this level; 1e-7 is rounding of the sums.
      if (there.correlation() <= sums.correlation() + 1e-7) break;
      placement = next;
      sums = there;
    }
    final_correlation = sums.correlation();
    // Finer ones correlate less, not more: no use going on.
    const bool hopeless = final_correlation < 0.5 * kAlikeCorrelation;
    if (sigma == finest || hopeless)
      out.correlation_before = sumsAt(grid, real, level, weights, start).correlation();
    if (hopeless) break;
  }
  out.correlation_after = final_correlation;
  out.placement = placement;
  out.used =
      final_correlation > kAlikeCorrelation && final_correlation > out.correlation_before + 1e-5;
  out.confidence = std::clamp(out.correlation_after, 0.0, 1.0);
  if (out.used) out.method = "Lucas and Kanade";
  return out;
}

}  // namespace echocine::compare
