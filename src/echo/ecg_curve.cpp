#include "echo/ecg_curve.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace echocine::echo {

namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// 255 where a pixel is not the sector's.
cv::Mat outsideOf(const Video& video, const Sector& sector) {
  constexpr double kMargin_px = 3;  // the edge's own pixels
  Sector grown = sector;
  grown.r_min = std::max(0.0, grown.r_min - kMargin_px);
  grown.r_max += kMargin_px;
  const double margin_rad = kMargin_px / std::max(1.0, 0.5 * grown.r_max);
  grown.first_rad -= margin_rad;
  grown.last_rad += margin_rad;
  cv::Mat out(video.height, video.width, CV_8U);
  for (int y = 0; y < video.height; ++y)
    for (int x = 0; x < video.width; ++x)
      out.at<std::uint8_t>(y, x) = grown.contains(x + 0.5, y + 0.5) ? 0 : 255;
  return out;
}

cv::Mat pictureOf(const Video& video, int frame) {
  return {video.height, video.width, CV_8U,
          const_cast<std::uint8_t*>(video.frames[static_cast<std::size_t>(frame)].data())};
}

// Brighter than the background by 40 greys, and by six deviations of its noise. Our choice.
double thresholdOf(const cv::Mat& picture, const cv::Mat& outside) {
  std::vector<int> counts(256, 0);
  int all = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x)
      if (outside.at<std::uint8_t>(y, x) != 0) ++counts[picture.at<std::uint8_t>(y, x)], ++all;
  const auto quantile = [&](double share) {
    int so_far = 0;
    for (int grey = 0; grey < 256; ++grey) {
      so_far += counts[static_cast<std::size_t>(grey)];
      if (so_far > share * all) return grey;
    }
    return 255;
  };
  // A normal distribution's deviation from its upper quartile.
  const int middle = quantile(0.5);
  return middle + std::max(40.0, 6 * (quantile(0.75) - middle) / 0.6745);
}

// The longest run of pixels in a column, and how many there are.
struct Run {
  int first = 0, last = -1, count = 0;
  int length() const { return last - first + 1; }
};

Run longestRun(const cv::Mat& mask, int x, int top, int bottom) {
  Run best;
  for (int y = top; y <= bottom; ++y) {
    if (mask.at<std::uint8_t>(y, x) == 0) continue;
    const int from = y;
    while (y < bottom && mask.at<std::uint8_t>(y + 1, x) != 0) ++y;
    ++best.count;
    if (y - from >= best.length()) best.first = from, best.last = y;
  }
  return best;
}

double middleOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How thick the curve may be.
double thickestFor(const cv::Mat& picture) {
  return std::max(4.0, 0.012 * picture.rows);
}

bool isCurve(const cv::Mat& part, const CurveBand& box) {
  if (box.columns() < 0.15 * part.cols || box.columns() < 48 || box.rows() > 0.35 * part.rows)
    return false;
  std::vector<double> lengths;
  int single = 0;
  for (int x = box.left; x <= box.right; ++x) {
    const Run run = longestRun(part, x, box.top, box.bottom);
    if (run.count == 0) continue;
    lengths.push_back(run.length());
    single += run.count == 1 ? 1 : 0;
  }
  const auto found = static_cast<double>(lengths.size());
  return found > 0.8 * box.columns() && single > 0.8 * found &&
         middleOf(lengths) <= thickestFor(part);
}

std::vector<CurveBand> curvesOf(const cv::Mat& picture, const cv::Mat& outside) {
  cv::Mat bright = (picture > thresholdOf(picture, outside)) & outside, closed, labels, stats,
          middles;
  cv::morphologyEx(bright, closed, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
  const int parts = cv::connectedComponentsWithStats(closed, labels, stats, middles, 8);
  std::vector<CurveBand> out;
  for (int i = 1; i < parts; ++i) {
    const int* s = stats.ptr<int>(i);
    const CurveBand box{s[cv::CC_STAT_LEFT], s[cv::CC_STAT_LEFT] + s[cv::CC_STAT_WIDTH] - 1,
                        s[cv::CC_STAT_TOP], s[cv::CC_STAT_TOP] + s[cv::CC_STAT_HEIGHT] - 1};
    if (box.columns() < 48) continue;
    if (isCurve((labels == i) & bright, box)) out.push_back(box);
  }
  return out;
}

bool overlap(const CurveBand& a, const CurveBand& b) {
  return a.top <= b.bottom && b.top <= a.bottom;
}

// The columns that differ, in runs.
std::vector<ChangedColumns> changesOf(const cv::Mat& before, const cv::Mat& now,
                                      const cv::Mat& outside, const CurveBand& band, double step) {
  constexpr int kGap_px = 2;  // that a run of columns may have
  std::vector<ChangedColumns> all;
  for (int x = band.left; x <= band.right; ++x) {
    int pixels = 0;
    for (int y = band.top; y <= band.bottom; ++y)
      pixels +=
          outside.at<std::uint8_t>(y, x) != 0 && std::abs(int{now.at<std::uint8_t>(y, x)} -
                                                          int{before.at<std::uint8_t>(y, x)}) > step
              ? 1
              : 0;
    if (pixels == 0) continue;
    const int column = x - band.left;
    if (all.empty() || column > all.back().last + 1 + kGap_px)
      all.push_back({column, column, pixels});
    else
      all.back().last = column, all.back().pixels += pixels;
  }
  // A codec's specks are single pixels.
  std::erase_if(all, [](const ChangedColumns& c) { return c.pixels < 3; });
  constexpr std::size_t kMost = 8;
  std::stable_sort(all.begin(), all.end(), [](const ChangedColumns& a, const ChangedColumns& b) {
    return a.pixels > b.pixels;
  });
  if (all.size() > kMost) all.resize(kMost);
  return all;
}

}  // namespace

std::vector<CurveBand> curveBands(const Video& video, const Sector& sector) {
  constexpr int kProbed = 15;  // frames
  const cv::Mat outside = outsideOf(video, sector);
  const int probed = std::min(kProbed, video.frameCount());
  struct Vote {
    CurveBand band;
    int frames = 0;
  };
  std::vector<Vote> votes;
  for (int i = 0; i < probed; ++i) {
    const int frame = static_cast<int>((i + 0.5) * video.frameCount() / probed);
    std::vector<bool> seen(votes.size(), false);
    for (const CurveBand& curve : curvesOf(pictureOf(video, frame), outside)) {
      std::size_t at = 0;
      while (at < votes.size() && !overlap(votes[at].band, curve)) ++at;
      if (at == votes.size()) {
        votes.push_back({curve, 0});
        seen.push_back(false);
      }
      CurveBand& band = votes[at].band;
      band = {std::min(band.left, curve.left), std::max(band.right, curve.right),
              std::min(band.top, curve.top), std::max(band.bottom, curve.bottom)};
      if (!seen[at]) ++votes[at].frames;
      seen[at] = true;
    }
  }
  std::erase_if(votes, [&](const Vote& v) { return 3 * v.frames < probed; });
  std::stable_sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) {
    return a.band.columns() > b.band.columns();
  });
  constexpr std::size_t kMost = 3;
  std::vector<CurveBand> out;
  for (const Vote& v : votes)
    if (out.size() < kMost)
      // Peaks of frames that were not looked at may reach a little farther.
      out.push_back({v.band.left, v.band.right, std::max(0, v.band.top - 2),
                     std::min(video.height - 1, v.band.bottom + 2)});
  return out;
}

EcgCurve curveIn(const CurveBand& band, const Video& video, const Sector& sector) {
  const cv::Mat outside = outsideOf(video, sector);
  EcgCurve out;
  out.band = band;
  const auto columns = static_cast<std::size_t>(band.columns());
  std::vector<std::vector<Run>> runs;
  std::vector<double> rows, lengths, brightness;
  for (int f = 0; f < video.frameCount(); ++f) {
    const cv::Mat picture = pictureOf(video, f);
    const double threshold = thresholdOf(picture, outside);
    const cv::Mat bright = (picture > threshold) & outside;
    runs.emplace_back();
    for (int x = band.left; x <= band.right; ++x) {
      const Run run = longestRun(bright, x, band.top, band.bottom);
      runs.back().push_back(run);
      if (run.count == 0) continue;
      rows.push_back(0.5 * (run.first + run.last));
      lengths.push_back(run.length());
      int most = 0;
      for (int y = run.first; y <= run.last; ++y)
        most = std::max(most, int{picture.at<std::uint8_t>(y, x)});
      brightness.push_back(most - threshold + 40);
    }
  }
  const double usual = middleOf(rows);
  out.thickness_px = middleOf(lengths);
  for (const std::vector<Run>& frame : runs) {
    std::vector<float> heights(columns, kNone);
    for (std::size_t x = 0; x < columns; ++x) {
      if (frame[x].count == 0) continue;
      // A steep stroke goes up to its end, or down.
      const double half = 0.5 * (std::min<double>(out.thickness_px, frame[x].length()) - 1),
                   up = usual - (frame[x].first + half), down = usual - (frame[x].last - half);
      heights[x] = static_cast<float>(std::abs(up) > std::abs(down) ? up : down);
    }
    out.height_px.push_back(std::move(heights));
  }
  // Share of the curve's brightness over the background: above a codec's noise, below the steps of
  // pixels that appear or vanish. Our choice.
  const double step = 0.4 * middleOf(brightness);
  out.changed.resize(video.frames.size());
  for (int f = 1; f < video.frameCount(); ++f)
    out.changed[static_cast<std::size_t>(f)] =
        changesOf(pictureOf(video, f - 1), pictureOf(video, f), outside, band, step);
  return out;
}

}  // namespace echocine::echo
