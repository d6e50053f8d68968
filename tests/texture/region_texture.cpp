#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "metrics/box_means.h"
#include "texture/echo_texture.h"

namespace echocine {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kErosion = 2;  // pixels
constexpr std::uint8_t kCavity = 1, kMyocardium = 2, kAtrium = 3;

using Mask = std::vector<std::uint8_t>;

class Regions {
 public:
  explicit Regions(const EchoPicture& picture) : picture_(picture) {}

  Mask eroded(std::uint8_t label) const {
    Mask mask(picture_.labels.size());
    for (int y = kErosion; y + kErosion < picture_.height; ++y)
      for (int x = kErosion; x + kErosion < picture_.width; ++x) {
        bool whole = true;
        for (int dy = -kErosion; dy <= kErosion && whole; ++dy)
          for (int dx = -kErosion; dx <= kErosion && whole; ++dx)
            whole = picture_.labels[at(x + dx, y + dy)] == label;
        mask[at(x, y)] = whole;
      }
    return mask;
  }

  double median(const Mask& mask) const {
    std::vector<float> values;
    for (std::size_t i = 0; i < mask.size(); ++i)
      if (mask[i] != 0) values.push_back(picture_.grey[i]);
    return orderStatistic(std::move(values), 0.5);
  }

  // Windows of 5 x 5 pixels wholly in the mask: (mean, standard deviation).
  template <typename F>
  void forWindows(const Mask& mask, int step, F&& visit) const {
    const BoxMeans boxes(picture_.width, picture_.height, picture_.grey, mask);
    for (int y = 2; y + 2 < picture_.height; y += step)
      for (int x = 2; x + 2 < picture_.width; x += step)
        if (const BoxMeans::Sums sums = boxes.at(x, y, 2, 2); sums.count == 25)
          visit(sums.mean(), sums.deviation());
  }

  // Grey less its mean over +-4 mm of the mask; NaN outside.
  std::vector<float> residual(const Mask& mask) const {
    const BoxMeans boxes(picture_.width, picture_.height, picture_.grey, mask);
    std::vector<float> rest =
        boxes.means(static_cast<int>(std::lround(4e-3 / picture_.pixel_x_m)),
                    static_cast<int>(std::lround(4e-3 / picture_.pixel_y_m)), 0);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = picture_.grey[i] - rest[i];
    return rest;
  }

  // Twice the first lag at which the autocovariance is half, in pixels, between lags linearly.
  double cell(const std::vector<float>& rest, bool along_x) const {
    constexpr int kMostLags = 16;
    double zero = 0, before = 1;
    for (int lag = 0; lag <= kMostLags; ++lag) {
      double sum = 0, pairs = 0;
      const int dx = along_x ? lag : 0, dy = along_x ? 0 : lag;
      for (int y = 0; y + dy < picture_.height; ++y)
        for (int x = 0; x + dx < picture_.width; ++x) {
          const auto product =
              static_cast<double>(rest[at(x, y)]) * static_cast<double>(rest[at(x + dx, y + dy)]);
          if (!std::isfinite(product)) continue;
          sum += product;
          pairs += 1;
        }
      const double covariance = sum / pairs;
      if (lag == 0) zero = covariance;
      const double here = covariance / zero;
      if (here <= 0.5) return 2 * (lag - 1 + (before - 0.5) / (before - here));
      before = here;
    }
    return kNone;
  }

 private:
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) +
           static_cast<std::size_t>(x);
  }
  const EchoPicture& picture_;
};

// Medians of the muscle left and right of the cavity on its middle rows.
std::pair<double, double> besideCavity(const EchoPicture& picture, const Mask& muscle) {
  const auto label = [&](int x, int y) {
    return picture.labels[static_cast<std::size_t>(y * picture.width + x)];
  };
  const auto ofRow = [&](int y) {  // its first and last pixel of the cavity
    std::pair<int, int> ends{picture.width, -1};
    for (int x = 0; x < picture.width; ++x)
      if (label(x, y) == kCavity) ends = {std::min(ends.first, x), x};
    return ends;
  };
  int first = picture.height, last = -1;
  for (int y = 0; y < picture.height; ++y)
    if (ofRow(y).second >= 0) {
      first = std::min(first, y);
      last = y;
    }
  std::vector<float> left, right;
  for (int y = static_cast<int>(std::ceil(first + 0.3 * (last - first)));
       y <= first + 0.7 * (last - first); ++y) {
    const auto ends = ofRow(y);
    for (int x = 0; x < picture.width; ++x) {
      const auto i = static_cast<std::size_t>(y * picture.width + x);
      if (muscle[i] != 0 && x < ends.first) left.push_back(picture.grey[i]);
      if (muscle[i] != 0 && x > ends.second) right.push_back(picture.grey[i]);
    }
  }
  return {orderStatistic(std::move(left), 0.5), orderStatistic(std::move(right), 0.5)};
}

struct Moments {
  double deviation = kNone, skew = kNone;
};

Moments momentsOf(const std::vector<float>& values) {
  double n = 0, sum = 0;
  for (const float v : values)
    if (std::isfinite(v)) {
      n += 1;
      sum += static_cast<double>(v);
    }
  if (n == 0) return {};
  double m2 = 0, m3 = 0;
  for (const float v : values)
    if (std::isfinite(v)) {
      const double d = static_cast<double>(v) - sum / n;
      m2 += d * d / n;
      m3 += d * d * d / n;
    }
  return {std::sqrt(m2), m3 / std::pow(m2, 1.5)};
}

// Least squares of the windows' deviation over their mean; dark windows are left out.
double levelSlope(const Regions& regions, const Mask& all) {
  constexpr double kDark = 16;
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  regions.forWindows(all, 2, [&](double mean, double deviation) {
    if (mean < kDark) return;
    n += 1;
    x += mean;
    y += deviation;
    xx += mean * mean;
    xy += mean * deviation;
  });
  return 100 * (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace

RegionTexture regionTexture(const EchoPicture& picture) {
  if (picture.labels.empty())
    return {kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
  const Regions regions(picture);
  const Mask cavity = regions.eroded(kCavity), muscle = regions.eroded(kMyocardium),
             atrium = regions.eroded(kAtrium);
  RegionTexture t;
  t.cavity_grey = regions.median(cavity);
  t.myocardium_grey = regions.median(muscle);
  t.atrium_grey = regions.median(atrium);
  std::vector<float> local;
  regions.forWindows(
      muscle, 3, [&](double, double deviation) { local.push_back(static_cast<float>(deviation)); });
  t.myocardial_local_std = orderStatistic(std::move(local), 0.5);
  const std::vector<float> rest = regions.residual(muscle);
  const Moments of_muscle = momentsOf(rest);
  t.myocardial_detrended_std = of_muscle.deviation;
  t.cavity_detrended_std = momentsOf(regions.residual(cavity)).deviation;
  t.residual_skew = of_muscle.skew;
  t.cell_horizontal_mm = regions.cell(rest, true) * 1e3 * picture.pixel_x_m;
  t.cell_vertical_mm = regions.cell(rest, false) * 1e3 * picture.pixel_y_m;
  Mask all(cavity.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = cavity[i] | muscle[i] | atrium[i];
  t.level_std_slope = levelSlope(regions, all);
  std::tie(t.left_wall_grey, t.right_wall_grey) = besideCavity(picture, muscle);
  return t;
}

}  // namespace echocine
