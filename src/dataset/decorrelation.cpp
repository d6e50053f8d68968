#include "dataset/decorrelation.h"

#include <algorithm>
#include <cmath>

#include "signal/picture.h"

namespace echocine::dataset {

namespace {

using Block = std::vector<float>;  // empty if the point is not shown

// Linear interpolation between pixel centres, at i + 1/2. Nothing beyond the outermost centres.
bool greyAt(const GreyImage& image, double x_px, double y_px, float& grey) {
  const double x = x_px - 0.5, y = y_px - 0.5;
  if (!(x >= 0 && y >= 0 && x <= image.width - 1 && y <= image.height - 1)) return false;
  const int i = std::min(static_cast<int>(x), image.width - 2),
            j = std::min(static_cast<int>(y), image.height - 2);
  const double u = x - i, v = y - j;
  const auto at = [&](int column, int row) {
    return static_cast<double>(
        image.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                     static_cast<std::size_t>(column)]);
  };
  grey = static_cast<float>((1 - v) * ((1 - u) * at(i, j) + u * at(i + 1, j)) +
                            v * ((1 - u) * at(i, j + 1) + u * at(i + 1, j + 1)));
  return true;
}

Block blockAround(const LoopSample& loop, const LoopFrame& frame, Vec3f place_m) {
  if (!isShown(loop, place_m)) return {};
  const PixelPoint centre = pixelOf(loop.geometry, toDouble(place_m));
  const double step_px = kBlockStep_m / loop.geometry.metres_per_pixel;
  Block block;
  for (int j = -kBlockHalf; j <= kBlockHalf; ++j)
    for (int i = -kBlockHalf; i <= kBlockHalf; ++i)
      if (!greyAt(frame.image, centre.x + i * step_px, centre.y + j * step_px,
                  block.emplace_back()))
        return {};
  return block;
}

// The followed points: evenly chosen among those in the middle of the wall.
std::vector<std::size_t> middlePoints(const LoopSample& loop) {
  constexpr std::uint8_t kMiddle = 1;
  std::vector<std::size_t> all, chosen;
  for (std::size_t n = 0; n < loop.tracked.size(); ++n)
    if (loop.tracked[n].layer == kMiddle) all.push_back(n);
  const std::size_t most = kMostBlocks, count = std::min(most, all.size());
  for (std::size_t k = 0; k < count; ++k) chosen.push_back(all[k * all.size() / count]);
  return chosen;
}

struct LagSum {
  double correlation = 0, away_mm = 0;
  std::size_t pairs = 0;
};

void addPoint(const LoopSample& loop, std::size_t point, std::vector<LagSum>& sums) {
  std::vector<Block> blocks;
  for (const LoopFrame& frame : loop.frames)
    blocks.push_back(blockAround(loop, frame, frame.tracks_m[point]));
  for (std::size_t lag = 0; lag < sums.size(); ++lag)
    for (std::size_t f = 0; f + lag < blocks.size(); ++f) {
      if (blocks[f].empty() || blocks[f + lag].empty()) continue;
      sums[lag].correlation += correlationOf(blocks[f], blocks[f + lag]);
      sums[lag].away_mm +=
          1e3 * std::abs(static_cast<double>(loop.frames[f + lag].tracks_m[point].y));
      ++sums[lag].pairs;
    }
}

}  // namespace

double correlationOf(const std::vector<float>& a, const std::vector<float>& b) {
  double mean_a = 0, mean_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += static_cast<double>(a[i]) / static_cast<double>(a.size());
    mean_b += static_cast<double>(b[i]) / static_cast<double>(a.size());
  }
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double da = static_cast<double>(a[i]) - mean_a, db = static_cast<double>(b[i]) - mean_b;
    ab += da * db;
    aa += da * da;
    bb += db * db;
  }
  constexpr double kConstant = 1e-9;  // squared grey levels: below it only rounding is left
  return aa > kConstant && bb > kConstant ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : 0;
}

Decorrelation decorrelationOf(const LoopSample& loop) {
  Decorrelation curve;
  const std::vector<std::size_t> points = middlePoints(loop);
  curve.blocks = static_cast<int>(points.size());
  if (points.empty()) return curve;
  std::vector<LagSum> sums(loop.frames.size() / 2 + 1);
  for (const std::size_t point : points) addPoint(loop, point, sums);
  for (std::size_t lag = 0; lag < sums.size(); ++lag) {
    if (sums[lag].pairs == 0) continue;
    const auto pairs = static_cast<double>(sums[lag].pairs);
    curve.lag_ms.push_back(1e3 * static_cast<double>(lag) / loop.scene.acquisition.frame_rate_hz);
    curve.correlation.push_back(sums[lag].correlation / pairs);
    curve.out_of_plane_mm.push_back(sums[lag].away_mm / pairs);
  }
  return curve;
}

}  // namespace echocine::dataset
