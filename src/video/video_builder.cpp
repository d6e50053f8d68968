#include "video/video_builder.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "core/error.h"

namespace echocine {

namespace {

// A pixel is coloured when red or blue stands this far from what a grey of its luma has: lossy
// codecs stay well under it, markers and Doppler colours well above. Our choice.
constexpr int kColourStep = 28;

// The same of the mean over a few pixels, which dithering leaves near grey. Our choice.
constexpr int kDitheredStep = 12;

int medianOf(std::vector<int>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Lossy codecs store colour at half resolution, so a coloured line bleeds into its neighbours.
PixelPlane widened(const PixelPlane& mask, int width, int height) {
  PixelPlane out(mask.size(), 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (mask[static_cast<std::size_t>(y * width + x)] == 0) continue;
      for (int v = std::max(0, y - 2); v <= std::min(height - 1, y + 2); ++v)
        for (int u = std::max(0, x - 2); u <= std::min(width - 1, x + 2); ++u)
          out[static_cast<std::size_t>(v * width + u)] = 1;
    }
  return out;
}

// Mean over the 7 x 7 pixels around one. A palette's greys are dithered: neighbours of opposite
// colours, whose mean is grey. A line of one pixel keeps a seventh of its colour.
template <typename ValueAt>
int meanAround(int x, int y, int width, int height, const ValueAt& value_at) {
  constexpr int kReach = 3;
  int sum = 0, count = 0;
  for (int v = std::max(0, y - kReach); v <= std::min(height - 1, y + kReach); ++v)
    for (int u = std::max(0, x - kReach); u <= std::min(width - 1, x + kReach); ++u, ++count)
      sum += value_at(u, v);
  return sum / count;
}

// Markers and Doppler boxes keep their colour over neighbours.
bool isColouredAround(const std::vector<std::int16_t>& colour, std::size_t at, int width,
                      int height) {
  const auto across = static_cast<std::size_t>(width);
  const int mean = meanAround(
      static_cast<int>(at % across), static_cast<int>(at / across), width, height,
      [&](int u, int v) {
        return int{colour[static_cast<std::size_t>(v) * across + static_cast<std::size_t>(u)]};
      });
  return std::abs(mean) > kDitheredStep;
}

}  // namespace

// Multiplications cannot overflow: each side is within the limit before their product is taken.
void checkLoopSize(const std::string& name, std::int64_t width, std::int64_t height,
                   std::int64_t frames) {
  if (width < 16 || height < 16)
    throw SceneError(
        fmt::format("{}: frames of {} x {} pixels show no sector, accepted: 16 x 16 and more", name,
                    width, height));
  if (width > kMaxFrameSide || height > kMaxFrameSide)
    throw SceneError(fmt::format(
        "{}: frames of {} x {} pixels, accepted: up to {} a side; give a smaller picture", name,
        width, height, kMaxFrameSide));
  if (frames > kMaxLoopFrames)
    throw SceneError(
        fmt::format("{}: more than {} frames; give a shorter part of it", name, kMaxLoopFrames));
  if (width * height > kMaxFramePixels)
    throw SceneError(fmt::format(
        "{}: frames of {} x {} pixels are beyond the limit of {} pixels; give a smaller picture",
        name, width, height, kMaxFramePixels));
  if (frames > kMaxLoopPixels / (width * height))
    throw SceneError(
        fmt::format("{}: more than {} frames of {} x {} pixels; give a shorter part of it", name,
                    kMaxLoopPixels / (width * height), width, height));
}

namespace {

double threadSeconds() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

VideoBuilder::VideoBuilder(std::string name)
    : from_s_(threadSeconds()), allowed_s_(kDecodeSeconds) {
  video_.name = std::move(name);
}

void VideoBuilder::expectBytes(std::size_t bytes) {
  allowed_s_ += kDecodeSecondsPerByte * static_cast<double>(bytes);
}

void VideoBuilder::checkTime() const {
  if (threadSeconds() - from_s_ <= allowed_s_) return;
  throw SceneError(fmt::format(
      "{}: takes longer than {:.0f} s to decode, {} frames so far; give a shorter part of it",
      video_.name, allowed_s_, video_.frames.size()));
}

// Some scanners tint their grey scale: each luma then has one colour, the same all over the
// picture, and counts as grey here. The median over a frame separates it from markers and Doppler
// boxes, the mean over neighbours from dithering.
void VideoBuilder::learnTint(const std::uint8_t* rgb, std::ptrdiff_t stride) {
  std::array<std::vector<int>, 17> red, blue;
  std::int64_t lit = 0, tinted = 0;
  for (int y = 0; y < video_.height; y += 2)
    for (int x = 0; x < video_.width; x += 2) {
      const auto mean = [&](int channel) {
        return meanAround(x, y, video_.width, video_.height,
                          [&](int u, int v) { return int{rgb[v * stride + 3 * u + channel]}; });
      };
      const int r = mean(0), b = mean(2), luma = lumaOf(r, mean(1), b);
      red[static_cast<std::size_t>(luma / 16)].push_back(r - luma);
      blue[static_cast<std::size_t>(luma / 16)].push_back(b - luma);
      if (luma < 24) continue;
      ++lit;
      tinted += std::abs(r - luma) > 8 || std::abs(b - luma) > 8 ? 1 : 0;
    }
  // Tinted scanners colour all of their greys; our choice of 60 % leaves room for black text.
  if (10 * tinted < 6 * lit) return;  // a grey picture with some colour on it
  for (std::size_t bin = 0; bin < 16; ++bin) {
    const bool enough = red[bin].size() > 100;  // else as the next darker one
    tint_red_[bin] = enough ? medianOf(red[bin]) : bin > 0 ? tint_red_[bin - 1] : 0;
    tint_blue_[bin] = enough ? medianOf(blue[bin]) : bin > 0 ? tint_blue_[bin - 1] : 0;
  }
}

void VideoBuilder::add(const std::uint8_t* rgb, int width, int height, std::ptrdiff_t stride) {
  Video& v = video_;
  checkTime();
  checkLoopSize(v.name, width, height, v.frameCount() + 1);
  if (v.frames.empty()) {
    v.width = width;
    v.height = height;
    v.coloured.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    learnTint(rgb, stride);
  }
  if (width != v.width || height != v.height)
    throw SceneError(
        fmt::format("{}: frame {} is {} x {} pixels, those before are {} x {}; give frames of one "
                    "size",
                    v.name, v.frameCount(), width, height, v.width, v.height));
  PixelPlane grey(v.coloured.size());
  std::vector<std::size_t> coloured;
  std::vector<std::int16_t> red(grey.size()), blue(grey.size());  // beyond what a grey has
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* p = rgb + y * stride;
    for (int x = 0; x < width; ++x, p += 3) {
      const int luma = lumaOf(p[0], p[1], p[2]);
      const auto at = static_cast<std::size_t>(y * width + x);
      grey[at] = static_cast<std::uint8_t>(luma);
      red[at] = static_cast<std::int16_t>(p[0] - luma - tint_red_[luma / 16]);
      blue[at] = static_cast<std::int16_t>(p[2] - luma - tint_blue_[luma / 16]);
      if (std::abs(red[at]) > kColourStep || std::abs(blue[at]) > kColourStep)
        coloured.push_back(at);
    }
  }
  for (const std::size_t at : coloured)
    if (isColouredAround(red, at, width, height) || isColouredAround(blue, at, width, height))
      v.coloured[at] = 1;
  v.frames.push_back(std::move(grey));
}

void noteUnevenFrames(double longest, double mean, Video& video) {
  constexpr double kEven = 1.5;  // our choice
  if (mean > 0 && longest > kEven * mean)
    video.notes.push_back(
        fmt::format("its frames are not evenly spaced: the longest step is {:.1f} times the mean; "
                    "used as if they were",
                    longest / mean));
}

std::vector<int> findRepeats(const std::vector<PixelPlane>& frames) {
  std::vector<double> differences;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    std::int64_t sum = 0;
    for (std::size_t p = 0; p < frames[i].size(); ++p)
      sum += std::abs(int{frames[i][p]} - int{frames[i - 1][p]});
    differences.push_back(static_cast<double>(sum));
  }
  if (differences.empty()) return {};
  // The upper quartile: a loop whose rate was doubled has every other difference zero.
  std::vector<double> sorted = differences;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[sorted.size() * 3 / 4];
  std::vector<int> repeats;
  for (std::size_t i = 0; i < differences.size(); ++i)
    if (differences[i] <= 0.05 * usual) repeats.push_back(static_cast<int>(i) + 1);
  return repeats;
}

Video VideoBuilder::finish() {
  Video& v = video_;
  if (v.frames.empty())
    throw SceneError(
        fmt::format("{}: holds no picture that can be decoded; give an AVI, MP4, GIF, "
                    "DICOM, or a folder of PNG or JPEG frames",
                    v.name));
  if (v.frames.size() == 1)
    throw SceneError(fmt::format(
        "{}: holds one frame; give a loop of at least two frames, better a whole beat", v.name));
  v.repeats = findRepeats(v.frames);
  // Not one frame differs from the one before.
  if (v.repeats.size() + 1 == v.frames.size())
    throw SceneError(fmt::format(
        "{}: is a still image, its {} frames are identical; give a loop that moves, better a whole "
        "beat",
        v.name, v.frames.size()));
  v.coloured = widened(v.coloured, v.width, v.height);
  return std::move(v);
}

}  // namespace echocine
