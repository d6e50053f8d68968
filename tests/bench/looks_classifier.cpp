#include "looks_classifier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "boosted_stumps.h"
#include "texture_table.h"
#include "video/read_video.h"

namespace echocine::bench {

namespace {

using Features = std::vector<double>;

std::vector<const Statistic*> statisticsWithoutLabels() {
  std::vector<const Statistic*> all;
  const RegionTexture none = regionTexture({});
  SectorTexture some;
  for (const Statistic& statistic : textureStatistics())
    if (std::isfinite(statistic.of(some, none))) all.push_back(&statistic);
  return all;
}

std::vector<Features> featuresOf(const std::vector<PictureGroup>& groups, std::size_t from,
                                 std::size_t step) {
  std::vector<Features> features;
  const std::vector<const Statistic*> statistics = statisticsWithoutLabels();
  const RegionTexture none = regionTexture({});
  for (std::size_t g = from; g < groups.size(); g += step)
    for (const SectorTexture& picture : groups[g].pictures) {
      Features row;
      for (const Statistic* statistic : statistics) row.push_back(statistic->of(picture, none));
      features.push_back(std::move(row));
    }
  return features;
}

struct Discriminant {
  Features scale, weights;  // standard deviation within a class; weights per deviation

  double of(const Features& x) const {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += weights[i] * x[i] / scale[i];
    return sum;
  }
};

Features meanOf(const std::vector<Features>& rows) {
  Features mean(rows.front().size());
  for (const Features& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      mean[i] += row[i] / static_cast<double>(rows.size());
  return mean;
}

// A tenth of the mean variance is added to each: few pictures, statistics that hang together.
Discriminant fit(const std::vector<Features>& a, const std::vector<Features>& b) {
  constexpr double kShrink = 0.1;
  const Features mean_a = meanOf(a), mean_b = meanOf(b);
  const int n = static_cast<int>(mean_a.size());
  cv::Mat within = cv::Mat::zeros(n, n, CV_64F), apart(n, 1, CV_64F), weights;
  const auto add = [&](const std::vector<Features>& rows, const Features& mean) {
    const double share = 0.5 / static_cast<double>(rows.size());
    for (const Features& row : rows)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          within.at<double>(i, j) += share * (row[i] - mean[i]) * (row[j] - mean[j]);
  };
  add(a, mean_a);
  add(b, mean_b);
  Discriminant d;
  for (int i = 0; i < n; ++i) d.scale.push_back(std::sqrt(within.at<double>(i, i)) + 1e-12);
  for (int i = 0; i < n; ++i) {
    apart.at<double>(i, 0) = (mean_a[i] - mean_b[i]) / d.scale[i];
    for (int j = 0; j < n; ++j)
      within.at<double>(i, j) =
          within.at<double>(i, j) / (d.scale[i] * d.scale[j]) + (i == j ? kShrink : 0);
  }
  cv::solve(within, apart, weights, cv::DECOMP_CHOLESKY);
  for (int i = 0; i < n; ++i) d.weights.push_back(weights.at<double>(i, 0));
  return d;
}

// Share of pairs that are in order; ties count half.
template <typename Classifier>
double areaUnderCurve(const Classifier& d, const std::vector<Features>& a,
                      const std::vector<Features>& b) {
  double in_order = 0;
  for (const Features& x : a)
    for (const Features& y : b) {
      const double u = d.of(x), v = d.of(y);
      in_order += u > v ? 1 : u == v ? 0.5 : 0;
    }
  return in_order / (static_cast<double>(a.size()) * static_cast<double>(b.size()));
}

}  // namespace

PictureGroup framesOf(const std::string& video, double mm_per_pixel) {
  const Video loop = readVideo(video);
  PictureGroup group;
  for (int i = 0; i < loop.frameCount(); i += 3) {
    EchoPicture picture;
    picture.width = loop.width;
    picture.height = loop.height;
    picture.pixel_x_m = picture.pixel_y_m = 1e-3 * mm_per_pixel;
    picture.grey.assign(loop.frames[i].begin(), loop.frames[i].end());
    group.pictures.push_back(sectorTexture(picture));
  }
  return group;
}

void printClassifier(const std::vector<PictureGroup>& simulated,
                     const std::vector<PictureGroup>& real) {
  const std::vector<Features> all_s = featuresOf(simulated, 0, 1), all_r = featuresOf(real, 0, 1);
  const Discriminant whole = fit(all_s, all_r);
  constexpr int kRounds = 50;  // our choice
  const BoostedStumps boosted(all_s, all_r, kRounds);
  fmt::print("area under the curve, linear and boosted: {:.3f} {:.3f} of what they were fitted to",
             areaUnderCurve(whole, all_s, all_r), areaUnderCurve(boosted, all_s, all_r));
  for (std::size_t held = 0; real.size() > 1 && held < real.size(); ++held) {
    std::vector<PictureGroup> others = real;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(held));
    const std::vector<Features> half = featuresOf(simulated, 0, 2), some = featuresOf(others, 0, 1),
                                held_s = featuresOf(simulated, 1, 2),
                                held_r = featuresOf({real[held]}, 0, 1);
    fmt::print(", {:.3f} {:.3f} of loop {} held out",
               areaUnderCurve(fit(half, some), held_s, held_r),
               areaUnderCurve(BoostedStumps(half, some, kRounds), held_s, held_r), held + 1);
  }
  const std::vector<const Statistic*> statistics = statisticsWithoutLabels();
  std::vector<std::size_t> order(statistics.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::abs(whole.weights[i]) > std::abs(whole.weights[j]);
  });
  const Features mean_s = meanOf(all_s), mean_r = meanOf(all_r);
  fmt::print("\nwhat weighs most:");
  for (int i = 0; i < 2; ++i)
    fmt::print(" {} {:.2f} (simulated {:.3g}, real {:.3g})", statistics[order[i]]->name,
               whole.weights[order[i]], mean_s[order[i]], mean_r[order[i]]);
  const std::vector<double> shares = boosted.shares();
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return shares[i] > shares[j]; });
  fmt::print("\nwhat the stumps ask most:");
  for (int i = 0; i < 2; ++i)
    fmt::print(" {} {:.2f} (simulated {:.3g}, real {:.3g})", statistics[order[i]]->name,
               shares[order[i]], mean_s[order[i]], mean_r[order[i]]);
  fmt::print("\n");
}

}  // namespace echocine::bench
