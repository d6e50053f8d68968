#include "export/montage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"

namespace echocine {

namespace {

constexpr int kLargestSide = 8192;  // px; our choice, that of readVideo()
constexpr int kCaptionGrey = 200;
constexpr double kRounding = 1e-9;  // frames: an instant on a frame's start shows that frame

// Area means when shrinking: single pixels of speckle would flicker.
GreyImage scaled(const GreyImage& image, int width, int height) {
  if (image.width == width && image.height == height) return image;
  const cv::Mat from(image.height, image.width, CV_8U,
                     const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat to;
  const bool shrinks = width < image.width;
  cv::resize(from, to, {width, height}, 0, 0, shrinks ? cv::INTER_AREA : cv::INTER_LINEAR);
  return {width, height, {to.datastart, to.dataend}};
}

void drawCaption(cv::Mat& cell, const std::string& caption) {
  const double scale = std::max(0.35, 0.6 * cell.rows / 600.0);
  int below = 0;
  const cv::Size size = cv::getTextSize(caption, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &below);
  cv::putText(cell, caption, {size.height, 2 * size.height}, cv::FONT_HERSHEY_SIMPLEX, scale,
              kCaptionGrey, 1, cv::LINE_AA);
}

int even(int length) {
  return length + length % 2;
}

}  // namespace

Montage::Montage(std::vector<MontageLoop> loops, int columns, int cell_width)
    : loops_(std::move(loops)) {
  CHECK_LT(0u, loops_.size());
  const auto count = static_cast<int>(loops_.size());
  columns_ = columns > 0 ? std::min(columns, count)
                         : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  const GreyImage& first = loops_.front().frames.front();
  cell_width_ = cell_width > 0 ? cell_width : first.width;
  cell_height_ = std::max(1, static_cast<int>(std::lround(static_cast<double>(cell_width_) *
                                                          first.height / first.width)));
  const int rows = (count + columns_ - 1) / columns_;
  width_ = even(columns_ * cell_width_);
  height_ = even(rows * cell_height_);
  if (std::max(width_, height_) > kLargestSide)
    throw SceneError(fmt::format("{} x {} pixels, accepted: up to {} a side; reduce --width",
                                 width_, height_, kLargestSide));
  for (MontageLoop& loop : loops_) {
    const GreyImage& frame = loop.frames.front();
    const double scale = std::min(static_cast<double>(cell_width_) / frame.width,
                                  static_cast<double>(cell_height_) / frame.height);
    const int width = std::max(1, static_cast<int>(std::lround(frame.width * scale))),
              height = std::max(1, static_cast<int>(std::lround(frame.height * scale)));
    parallelBlocks(loop.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        loop.frames[i] = scaled(loop.frames[i], width, height);
    });
  }
}

GreyImage Montage::at(double phase) const {
  GreyImage picture{width_, height_, {}};
  picture.pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  cv::Mat canvas(height_, width_, CV_8U, picture.pixels.data());
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    const MontageLoop& loop = loops_[i];
    const auto count = static_cast<double>(loop.frames.size());
    const auto n =
        static_cast<std::size_t>(std::clamp(std::floor(phase * count + kRounding), 0.0, count - 1));
    const GreyImage& frame = loop.frames[n];
    const int place = static_cast<int>(i);
    cv::Mat cell = canvas({(place % columns_) * cell_width_, (place / columns_) * cell_height_,
                           cell_width_, cell_height_});
    cv::Mat(frame.height, frame.width, CV_8U, const_cast<std::uint8_t*>(frame.pixels.data()))
        .copyTo(cell({(cell_width_ - frame.width) / 2, (cell_height_ - frame.height) / 2,
                      frame.width, frame.height}));
    if (!loop.caption.empty()) drawCaption(cell, loop.caption);
  }
  return picture;
}

}  // namespace echocine
