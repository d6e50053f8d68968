#include "echo/persistence.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace echocine::echo {

namespace {

// Our choice. Relative to the sector's radius: 0.6 mm and 3 mm of 16 cm.
constexpr double kGrainOfRadius = 1.0 / 90, kBlockOfRadius = 1.0 / 17;
constexpr double kLeastGrey = 12;     // mean over the loop: above black
constexpr double kMostOutside = 0.1;  // of a block
constexpr double kQuantile = 0.1;
constexpr std::size_t kLeastBlocks = 20;
constexpr int kLeastPairs = 6;

// Mean square differences of pictures one and two frames apart, by pixel.
struct Differences {
  cv::Mat mean_grey, one, two;
  int ones = 0, twos = 0;
};

cv::Mat grainOf(const cv::Mat& grey, double sigma_px) {
  cv::Mat smooth;
  cv::GaussianBlur(grey, smooth, {}, sigma_px);
  return grey - smooth;
}

void addSquare(const cv::Mat& a, const cv::Mat& b, cv::Mat& sum, int& count) {
  const cv::Mat difference = a - b;
  cv::accumulateSquare(difference, sum);
  ++count;
}

Differences differencesOf(const Video& video, double sigma_px) {
  const cv::Size size(video.width, video.height);
  Differences out{cv::Mat::zeros(size, CV_32F), cv::Mat::zeros(size, CV_32F),
                  cv::Mat::zeros(size, CV_32F)};
  cv::Mat last, before;  // grain of the previous frame and of the one before; empty: none
  for (int f = 0; f < video.frameCount(); ++f) {
    const auto& plane = video.frames[static_cast<std::size_t>(f)];
    cv::Mat grey;
    cv::Mat(plane).reshape(1, video.height).convertTo(grey, CV_32F);
    cv::accumulate(grey, out.mean_grey);
    if (video.isRepeat(f)) {
      last = before = cv::Mat();
      continue;
    }
    const cv::Mat grain = grainOf(grey, sigma_px);
    if (!last.empty()) addSquare(grain, last, out.one, out.ones);
    if (!before.empty()) addSquare(grain, before, out.two, out.twos);
    before = last;
    last = grain;
  }
  out.mean_grey /= std::max(1, video.frameCount());
  return out;
}

// 1 for pixels with echoes.
cv::Mat echoesOf(const EchoLoop& loop, const cv::Mat& mean_grey) {
  cv::Mat mask = mean_grey >= kLeastGrey;
  for (int y = 0; y < mask.rows; ++y)
    for (int x = 0; x < mask.cols; ++x) {
      const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.cols) +
                      static_cast<std::size_t>(x);
      if (!loop.sector().contains(x, y) || (at < loop.overlay.size() && loop.overlay[at] != 0))
        mask.at<std::uint8_t>(y, x) = 0;
    }
  return mask / 255;
}

}  // namespace

std::optional<double> persistenceOf(const EchoLoop& loop) {
  const double radius_px = loop.sector().r_max;
  const int block_px = static_cast<int>(std::lround(kBlockOfRadius * radius_px));
  if (block_px < 4) return std::nullopt;
  const Differences d = differencesOf(loop.video, kGrainOfRadius * radius_px);
  if (d.ones < kLeastPairs || d.twos < kLeastPairs) return std::nullopt;
  const cv::Mat mask = echoesOf(loop, d.mean_grey);
  std::vector<double> ratios;
  for (int y = 0; y + block_px <= mask.rows; y += block_px)
    for (int x = 0; x + block_px <= mask.cols; x += block_px) {
      const cv::Rect block(x, y, block_px, block_px);
      if (cv::countNonZero(mask(block)) < (1 - kMostOutside) * block_px * block_px) continue;
      const double one = cv::mean(d.one(block), mask(block))[0] / d.ones,
                   two = cv::mean(d.two(block), mask(block))[0] / d.twos;
      if (one > 0) ratios.push_back((two - one) / one);
    }
  if (ratios.size() < kLeastBlocks) return std::nullopt;
  const auto tenth = ratios.begin() + static_cast<std::ptrdiff_t>(
                                          kQuantile * static_cast<double>(ratios.size() - 1));
  std::nth_element(ratios.begin(), tenth, ratios.end());
  constexpr double kSure = 0.4, kMoving = 0.64, kMost = 0.8;
  const double r = std::max(0.0, *tenth);
  return std::min(kMost, r < kSure ? r : std::max(kSure, kMoving * r));
}

}  // namespace echocine::echo
