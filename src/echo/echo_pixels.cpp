#include "echo/echo_pixels.h"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

namespace echocine::echo {

namespace {

int backgroundGrey(const PixelPlane& highest) {
  std::array<int, 256> counts{};
  for (const std::uint8_t g : highest) ++counts[g];
  // The background is dark: the most frequent of the darker greys.
  return static_cast<int>(std::max_element(counts.begin(), counts.begin() + 64) - counts.begin());
}

// The largest 8-connected part: a scanner's logo, its scale bars and the ECG are smaller than its
// sector.
cv::Mat largestPart(const cv::Mat& mask) {
  cv::Mat labels, stats, centroids;
  const int parts = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8);
  int best = 0, area = 0;
  for (int i = 1; i < parts; ++i)
    if (stats.at<int>(i, cv::CC_STAT_AREA) > area) {
      area = stats.at<int>(i, cv::CC_STAT_AREA);
      best = i;
    }
  return best > 0 ? cv::Mat(labels == best) : cv::Mat::zeros(mask.size(), CV_8U);
}

}  // namespace

// Bright pixels count too, for a wall that stands still never moves; the margin of 4 greys is a
// codec's noise.
EchoPixels echoPixels(const Video& video, int moving) {
  EchoPixels area{video.width, video.height, {}, video.frames.front(), {}};
  PixelPlane lowest = video.frames.front();
  const auto row = [](const PixelPlane& p) {
    return cv::Mat(1, static_cast<int>(p.size()), CV_8U, const_cast<std::uint8_t*>(p.data()));
  };
  cv::Mat high = row(area.highest), low = row(lowest);
  for (const PixelPlane& frame : video.frames) {
    cv::max(high, row(frame), high);
    cv::min(low, row(frame), low);
  }
  area.range.resize(lowest.size());
  const int background = backgroundGrey(area.highest);
  cv::Mat mask(video.height, video.width, CV_8U);
  for (std::size_t p = 0; p < lowest.size(); ++p) {
    area.range[p] = static_cast<std::uint8_t>(area.highest[p] - lowest[p]);
    const bool live = area.range[p] > moving || area.highest[p] > background + 4 + 2 * moving;
    mask.data[p] = live && video.coloured[p] == 0 ? 255 : 0;
  }
  const cv::Mat three = cv::getStructuringElement(cv::MORPH_RECT, {3, 3});
  cv::Mat opened;
  // Single pixels, text and thin lines go.
  cv::morphologyEx(mask, opened, cv::MORPH_OPEN, three);
  // Dark cavities and speckle gaps must not cut the part in pieces.
  const int reach = std::max(3, video.width / 100) | 1;
  cv::morphologyEx(opened, opened, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_ELLIPSE, {reach, reach}));
  const cv::Mat part = largestPart(opened) & mask;
  area.live.assign(part.datastart, part.dataend);
  return area;
}

}  // namespace echocine::echo
