#include "export/montage.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/part_file.h"

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

// A file without a name. It needs no clean-up after a kill.
class Montage::Store {
 public:
  explicit Store(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~Store() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  // The place of the first byte.
  std::size_t add(const std::vector<std::uint8_t>& bytes) {
    open();
    const std::size_t place = size_;
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done,
                                 static_cast<off_t>(size_ + done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail();
      done += static_cast<std::size_t>(n);
    }
    size_ += bytes.size();
    return place;
  }

  void read(std::size_t place, std::vector<std::uint8_t>& bytes) const {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                static_cast<off_t>(place + done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) fail();
      done += static_cast<std::size_t>(n);
    }
  }

 private:
  void open() {
    if (descriptor_ >= 0) return;
    const PartFile part = makePart(folder_ / "montage");
    if (part.descriptor < 0) fail();
    descriptor_ = part.descriptor;
    ::unlink(part.name.c_str());
  }
  [[noreturn]] void fail() const {
    throw JobError(fmt::format("{}: frames of a montage cannot be kept there: {}", folder_.string(),
                               std::strerror(errno)));
  }

  std::filesystem::path folder_;
  int descriptor_ = -1;
  std::size_t size_ = 0;
};

Montage::Montage(std::size_t count, int columns, int cell_width, std::filesystem::path scratch)
    : count_(count),
      columns_(columns),
      cell_width_(cell_width),
      store_(std::make_unique<Store>(std::move(scratch))) {
  CHECK_LT(0u, count);
}

Montage::~Montage() = default;

void Montage::layOut(const GreyImage& first) {
  const auto count = static_cast<int>(count_);
  columns_ = columns_ > 0 ? std::min(columns_, count)
                          : static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  if (cell_width_ <= 0) cell_width_ = first.width;
  cell_height_ = std::max(1, static_cast<int>(std::lround(static_cast<double>(cell_width_) *
                                                          first.height / first.width)));
  const int rows = (count + columns_ - 1) / columns_;
  width_ = even(columns_ * cell_width_);
  height_ = even(rows * cell_height_);
  if (std::max(width_, height_) > kLargestSide)
    throw SceneError(fmt::format("{} x {} pixels, accepted: up to {} a side; reduce --width",
                                 width_, height_, kLargestSide));
}

void Montage::add(MontageLoop loop) {
  CHECK_LT(cells_.size(), count_);
  const GreyImage& frame = loop.frames.front();
  if (cells_.empty()) layOut(frame);
  const double scale = std::min(static_cast<double>(cell_width_) / frame.width,
                                static_cast<double>(cell_height_) / frame.height);
  Cell cell{loop.caption, std::max(1, static_cast<int>(std::lround(frame.width * scale))),
            std::max(1, static_cast<int>(std::lround(frame.height * scale))), loop.frames.size()};
  parallelBlocks(loop.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      loop.frames[i] = scaled(loop.frames[i], cell.width, cell.height);
  });
  if (cells_.size() + 1 == count_) {
    last_ = std::move(loop.frames);
  } else {
    for (std::size_t i = 0; i < loop.frames.size(); ++i) {
      const std::size_t place = store_->add(loop.frames[i].pixels);
      if (i == 0) cell.first_byte = place;
    }
  }
  cells_.push_back(std::move(cell));
}

GreyImage Montage::frameOf(const Cell& cell, std::size_t n) const {
  if (&cell == &cells_.back()) return last_[n];
  GreyImage frame{cell.width, cell.height, {}};
  frame.pixels.resize(static_cast<std::size_t>(cell.width) * static_cast<std::size_t>(cell.height));
  store_->read(cell.first_byte + n * frame.pixels.size(), frame.pixels);
  return frame;
}

GreyImage Montage::at(double phase) const {
  GreyImage picture{width_, height_, {}};
  picture.pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  cv::Mat canvas(height_, width_, CV_8U, picture.pixels.data());
  CHECK_EQ(cells_.size(), count_);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const auto count = static_cast<double>(cells_[i].frames);
    const auto n =
        static_cast<std::size_t>(std::clamp(std::floor(phase * count + kRounding), 0.0, count - 1));
    const GreyImage frame = frameOf(cells_[i], n);
    const int place = static_cast<int>(i);
    cv::Mat cell = canvas({(place % columns_) * cell_width_, (place / columns_) * cell_height_,
                           cell_width_, cell_height_});
    cv::Mat(frame.height, frame.width, CV_8U, const_cast<std::uint8_t*>(frame.pixels.data()))
        .copyTo(cell({(cell_width_ - frame.width) / 2, (cell_height_ - frame.height) / 2,
                      frame.width, frame.height}));
    if (!cells_[i].caption.empty()) drawCaption(cell, cells_[i].caption);
  }
  return picture;
}

}  // namespace echocine
