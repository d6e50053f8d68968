#include "looks_classifier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "boosted_stumps.h"
#include "echo/sector.h"
#include "metrics/linear_discriminant.h"
#include "video/read_video.h"

namespace echocine::bench {

namespace {

std::vector<FeatureRow> featuresOf(const std::vector<PictureGroup>& groups, std::size_t from,
                                   std::size_t step) {
  std::vector<FeatureRow> features;
  for (std::size_t g = from; g < groups.size(); g += step)
    for (const SectorTexture& picture : groups[g].pictures) {
      FeatureRow row;
      for (const SectorStatistic& statistic : sectorStatistics())
        row.push_back(statistic.of(picture));
      features.push_back(std::move(row));
    }
  return features;
}

template <typename Classifier>
double areaOf(const Classifier& classifier, const std::vector<FeatureRow>& a,
              const std::vector<FeatureRow>& b) {
  std::vector<double> scores_a, scores_b;
  for (const FeatureRow& row : a) scores_a.push_back(classifier.of(row));
  for (const FeatureRow& row : b) scores_b.push_back(classifier.of(row));
  return areaUnderCurve(scores_a, scores_b);
}

}  // namespace

EchoPicture coarser(const EchoPicture& picture, double mm_per_pixel) {
  EchoPicture out;
  const double x = 1e3 * picture.pixel_x_m / mm_per_pixel,
               y = 1e3 * picture.pixel_y_m / mm_per_pixel;
  if (x >= 1 || y >= 1) return picture;
  cv::Mat from(picture.height, picture.width, CV_32F), to;
  std::copy(picture.grey.begin(), picture.grey.end(), from.ptr<float>());
  cv::resize(from, to, {}, x, y, cv::INTER_AREA);
  out.width = to.cols;
  out.height = to.rows;
  out.pixel_x_m = picture.pixel_x_m * picture.width / to.cols;
  out.pixel_y_m = picture.pixel_y_m * picture.height / to.rows;
  out.grey.assign(to.begin<float>(), to.end<float>());
  return out;
}

PictureGroup framesOf(const std::string& video, double mm_per_pixel, double coarse_mm) {
  const Video loop = readVideo(video);
  const echo::Sector sector = echo::findSector(loop).sector;
  PictureGroup group;
  for (int i = 0; i < loop.frameCount(); i += 3) {
    EchoPicture picture;
    picture.width = loop.width;
    picture.height = loop.height;
    picture.pixel_x_m = picture.pixel_y_m = 1e-3 * mm_per_pixel;
    picture.grey.assign(loop.frames[i].begin(), loop.frames[i].end());
    std::size_t pixel = 0;
    for (int y = 0; y < loop.height; ++y)
      for (int x = 0; x < loop.width; ++x, ++pixel)
        if (!sector.contains(x + 0.5, y + 0.5)) picture.grey[pixel] = 0;
    group.pictures.push_back(sectorTexture(coarser(picture, coarse_mm)));
  }
  return group;
}

void printClassifier(const std::vector<PictureGroup>& simulated,
                     const std::vector<PictureGroup>& real) {
  const std::vector<FeatureRow> all_s = featuresOf(simulated, 0, 1), all_r = featuresOf(real, 0, 1);
  const LinearDiscriminant whole(all_s, all_r);
  constexpr int kRounds = 50;  // our choice
  const BoostedStumps boosted(all_s, all_r, kRounds);
  fmt::print("area under the curve, linear and boosted: {:.3f} {:.3f} of what they were fitted to",
             areaOf(whole, all_s, all_r), areaOf(boosted, all_s, all_r));
  for (std::size_t held = 0; real.size() > 1 && held < real.size(); ++held) {
    std::vector<PictureGroup> others = real;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(held));
    const std::vector<FeatureRow> half = featuresOf(simulated, 0, 2),
                                  some = featuresOf(others, 0, 1),
                                  held_s = featuresOf(simulated, 1, 2),
                                  held_r = featuresOf({real[held]}, 0, 1);
    fmt::print(", {:.3f} {:.3f} of loop {} held out",
               areaOf(LinearDiscriminant(half, some), held_s, held_r),
               areaOf(BoostedStumps(half, some, kRounds), held_s, held_r), held + 1);
  }
  const std::span<const SectorStatistic> statistics = sectorStatistics();
  constexpr int kShown = 3;
  std::vector<std::size_t> order(statistics.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return std::abs(whole.weights()[i]) > std::abs(whole.weights()[j]);
  });
  const FeatureRow mean_s = meanOf(all_s), mean_r = meanOf(all_r);
  fmt::print("\nwhat weighs most:");
  for (int i = 0; i < kShown; ++i)
    fmt::print(" {} {:.2f} (simulated {:.3g}, real {:.3g})", statistics[order[i]].name,
               whole.weights()[order[i]], mean_s[order[i]], mean_r[order[i]]);
  std::vector<FeatureRow> loop_means;
  for (const PictureGroup& loop : real) loop_means.push_back(meanOf(featuresOf({loop}, 0, 1)));
  fmt::print("\nmeans, simulated with standard deviation, and each loop:");
  for (std::size_t i = 0; i < statistics.size(); ++i) {
    double squares = 0;
    for (const FeatureRow& row : all_s) squares += std::pow(row[i] - mean_s[i], 2);
    fmt::print("\n  {} {:.3g} +- {:.2g};", statistics[i].name, mean_s[i],
               std::sqrt(squares / static_cast<double>(all_s.size())));
    for (const FeatureRow& mean : loop_means) fmt::print(" {:.3g}", mean[i]);
  }
  const std::vector<double> shares = boosted.shares();
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return shares[i] > shares[j]; });
  fmt::print("\nwhat the stumps ask most:");
  for (int i = 0; i < kShown; ++i)
    fmt::print(" {} {:.2f} (simulated {:.3g}, real {:.3g})", statistics[order[i]].name,
               shares[order[i]], mean_s[order[i]], mean_r[order[i]]);
  fmt::print("\n");
}

}  // namespace echocine::bench
