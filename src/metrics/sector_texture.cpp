#include "metrics/sector_texture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "metrics/box_means.h"

namespace echocine {

double orderStatistic(std::vector<float> values, double q) {
  std::erase_if(values, [](float v) { return !std::isfinite(v); });
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank =
      std::min(static_cast<std::size_t>(q * static_cast<double>(values.size())), values.size() - 1);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank),
                   values.end());
  return static_cast<double>(values[rank]);
}

namespace {

class Sector {
 public:
  explicit Sector(const EchoPicture& picture)
      : picture_(picture), mask_(picture.grey.size()), interior_(picture.grey.size()) {
    fillMask();
    boxes_.emplace(picture.width, picture.height, picture.grey, mask_);
    // Neighbours of the interior are inside the picture.
    const int half_x = std::max(pixelsX(3), 1), half_y = std::max(pixelsY(3), 1);
    forAll(mask_, [&](int x, int y, std::size_t i) {
      interior_[i] = boxes_->share(x, y, half_x, half_y) >= 0.999;
    });
  }

  void greys(SectorTexture& t) const {
    std::vector<float> all;
    double dark = 0;
    forAll(mask_, [&](int, int, std::size_t i) {
      all.push_back(picture_.grey[i]);
      dark += picture_.grey[i] < 20;
    });
    t.dark_fraction = dark / static_cast<double>(all.size());
    t.grey_p5 = orderStatistic(all, 0.05);
    t.grey_p50 = orderStatistic(all, 0.5);
    t.grey_p95 = orderStatistic(all, 0.95);
    std::vector<float> near;
    int first_row = picture_.height;
    forAll(mask_, [&](int, int y, std::size_t i) {
      first_row = std::min(first_row, y);
      if (y < first_row + pixelsY(15)) near.push_back(picture_.grey[i]);
    });
    t.near_field_grey = orderStatistic(std::move(near), 0.5);
  }

  void deviations(SectorTexture& t) const {
    const int half_x = std::max(pixelsX(0.75), 1), half_y = std::max(pixelsY(0.75), 1);
    const std::vector<float> means = boxes_->means(pixelsX(4), pixelsY(4), 0.5);
    std::vector<float> local;
    double squares = 0, n = 0;
    forAll(interior_, [&](int x, int y, std::size_t i) {
      local.push_back(static_cast<float>(boxes_->at(x, y, half_x, half_y).deviation()));
      const double d = static_cast<double>(picture_.grey[i] - means[i]);
      if (!std::isfinite(d)) return;
      squares += d * d;
      n += 1;
    });
    t.local_std = orderStatistic(std::move(local), 0.5);
    t.detrended_std = std::sqrt(squares / n);
  }

  void edges(SectorTexture& t) const {
    const std::vector<float> blurred =
        boxes_->means(std::max(pixelsX(0.5), 1), std::max(pixelsY(0.5), 1), 0);
    const double per_x = 1 / (2e3 * picture_.pixel_x_m), per_y = 1 / (2e3 * picture_.pixel_y_m);
    const auto w = static_cast<std::size_t>(picture_.width);
    std::vector<float> slopes;
    forAll(interior_, [&](int, int, std::size_t i) {
      slopes.push_back(static_cast<float>(
          std::hypot(static_cast<double>(blurred[i + 1] - blurred[i - 1]) * per_x,
                     static_cast<double>(blurred[i + w] - blurred[i - w]) * per_y)));
    });
    t.gradient_p50 = orderStatistic(slopes, 0.5);
    t.gradient_p95 = orderStatistic(std::move(slopes), 0.95);
    t.ridge_fraction = ridges(blurred);
  }

  void correlations(SectorTexture& t) const {
    const std::vector<float> means = boxes_->means(pixelsX(3), pixelsY(3), 0.5);
    std::vector<float> rest(means.size());
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = picture_.grey[i] - means[i];
    for (std::size_t lag = 0; lag < std::size(kTextureLags_mm); ++lag) {
      t.radial[lag] = correlation(rest, kTextureLags_mm[lag], true);
      t.tangential[lag] = correlation(rest, kTextureLags_mm[lag], false);
    }
  }

 private:
  int pixelsX(double mm) const {
    return static_cast<int>(std::lround(1e-3 * mm / picture_.pixel_x_m));
  }
  int pixelsY(double mm) const {
    return static_cast<int>(std::lround(1e-3 * mm / picture_.pixel_y_m));
  }

  template <typename F>
  void forAll(const std::vector<std::uint8_t>& where, F&& visit) const {
    std::size_t i = 0;
    for (int y = 0; y < picture_.height; ++y)
      for (int x = 0; x < picture_.width; ++x, ++i)
        if (where[i] != 0) visit(x, y, i);
  }

  void fillMask() {
    for (int y = 0; y < picture_.height; ++y) {
      const float* row = picture_.grey.data() + static_cast<std::ptrdiff_t>(y) * picture_.width;
      int first = 0, last = picture_.width - 1;
      while (first < picture_.width && !(row[first] > 0)) ++first;
      while (last > first && !(row[last] > 0)) --last;
      if (last - first < 2) continue;
      if (apex_y_ < 0) {
        apex_y_ = y;
        apex_x_ = 0.5 * (first + last);
      }
      std::fill_n(mask_.begin() + static_cast<std::ptrdiff_t>(y) * picture_.width + first,
                  last - first + 1, std::uint8_t{1});
    }
  }

  bool interior(int x, int y) const {
    return x >= 0 && y >= 0 && x < picture_.width && y < picture_.height &&
           interior_[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width) +
                     static_cast<std::size_t>(x)] != 0;
  }

  double ridges(const std::vector<float>& blurred) const {
    const int dx = pixelsX(1), dy = pixelsY(1);
    double found = 0, asked = 0;
    forAll(interior_, [&](int x, int y, std::size_t i) {
      if (!interior(x - dx, y) || !interior(x + dx, y) || !interior(x, y - dy) ||
          !interior(x, y + dy))
        return;
      asked += 1;
      const float here = blurred[i];
      const auto above = [&](int sx, int sy) {
        const auto step = static_cast<std::ptrdiff_t>(sy) * dy * picture_.width + sx * dx;
        const auto at = static_cast<std::ptrdiff_t>(i);
        return here > blurred[static_cast<std::size_t>(at + step)] + 40 &&
               here > blurred[static_cast<std::size_t>(at - step)] + 40;
      };
      found += here > 120 && (above(1, 0) || above(0, 1) || above(1, 1) || above(1, -1));
    });
    return found / asked;
  }

  // NaN outside, and beside what is not known.
  double bilinear(const std::vector<float>& plane, double x, double y) const {
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    if (x0 < 0 || y0 < 0 || x0 + 1 >= picture_.width || y0 + 1 >= picture_.height)
      return std::numeric_limits<double>::quiet_NaN();
    const double fx = x - x0, fy = y - y0;
    const float* at = plane.data() + static_cast<std::ptrdiff_t>(y0) * picture_.width + x0;
    const auto v = [&](int dx, int dy) {
      return static_cast<double>(at[static_cast<std::ptrdiff_t>(dy) * picture_.width + dx]);
    };
    return (1 - fy) * ((1 - fx) * v(0, 0) + fx * v(1, 0)) +
           fy * ((1 - fx) * v(0, 1) + fx * v(1, 1));
  }

  // Over a grid of about 1 mm, from 3 mm below the apex on.
  double correlation(const std::vector<float>& rest, double lag_mm, bool radial) const {
    const double sx_mm = 1e3 * picture_.pixel_x_m, sy_mm = 1e3 * picture_.pixel_y_m;
    double both = 0, here2 = 0, there2 = 0;
    for (int y = apex_y_ + pixelsY(3); y < picture_.height; y += std::max(pixelsY(1), 1))
      for (int x = pixelsX(3); x < picture_.width; x += std::max(pixelsX(1), 1)) {
        if (!interior(x, y)) continue;
        const double ux = (x - apex_x_) * sx_mm, uy = (y - apex_y_) * sy_mm;
        const double r = std::hypot(ux, uy);
        if (!(r > lag_mm)) continue;
        const double vx = radial ? ux / r : -uy / r, vy = radial ? uy / r : ux / r;
        const double here = bilinear(rest, x, y),
                     there = bilinear(rest, x + lag_mm * vx / sx_mm, y + lag_mm * vy / sy_mm);
        if (!std::isfinite(here) || !std::isfinite(there)) continue;
        both += here * there;
        here2 += here * here;
        there2 += there * there;
      }
    return both / std::sqrt(here2 * there2);
  }

  const EchoPicture& picture_;
  std::vector<std::uint8_t> mask_, interior_;
  std::optional<BoxMeans> boxes_;
  int apex_y_ = -1;
  double apex_x_ = 0;
};

}  // namespace

SectorTexture sectorTexture(const EchoPicture& picture) {
  const Sector sector(picture);
  SectorTexture texture;
  sector.greys(texture);
  sector.deviations(texture);
  sector.edges(texture);
  sector.correlations(texture);
  return texture;
}

std::span<const SectorStatistic> sectorStatistics() {
  using Texture = const SectorTexture&;
  static constexpr SectorStatistic kAll[] = {
      {"localStd", [](Texture t) { return t.local_std; }},
      {"detrendedStd", [](Texture t) { return t.detrended_std; }},
      {"gradientP50", [](Texture t) { return t.gradient_p50; }},
      {"gradientP95", [](Texture t) { return t.gradient_p95; }},
      {"ridgeFraction", [](Texture t) { return t.ridge_fraction; }},
      {"radialCorr1", [](Texture t) { return t.radial[0]; }},
      {"radialCorr2", [](Texture t) { return t.radial[1]; }},
      {"radialCorr4", [](Texture t) { return t.radial[2]; }},
      {"tangentialCorr1", [](Texture t) { return t.tangential[0]; }},
      {"tangentialCorr2", [](Texture t) { return t.tangential[1]; }},
      {"tangentialCorr4", [](Texture t) { return t.tangential[2]; }}};
  return kAll;
}

}  // namespace echocine
