#include "doppler/colour_overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/units.h"

namespace echocine {

namespace {

constexpr int kHalf = 128;
constexpr double kLeastPower_db = -55;
constexpr std::uint8_t kTextIndex = 90;

}  // namespace

GreyColours dopplerColours() {
  GreyColours colours;
  for (int i = 0; i < kHalf; ++i) {
    const auto grey = static_cast<std::uint8_t>(2 * i + i / 64);
    colours[static_cast<std::size_t>(i)] = {grey, grey, grey};
    const double v = (i + 0.5) / kHalf * 2 - 1, size = std::abs(v);
    const auto strong = static_cast<std::uint8_t>(std::lround(90 + 165 * std::sqrt(size)));
    const auto second = static_cast<std::uint8_t>(std::lround(230 * size * size));
    colours[static_cast<std::size_t>(kHalf + i)] =
        v > 0 ? PaletteColour{strong, second, 0} : PaletteColour{0, second, strong};
  }
  return colours;
}

std::uint8_t colourIndex(double velocity_m_s, double nyquist_m_s) {
  const double turns = velocity_m_s / (2 * nyquist_m_s) + 0.5;
  const double part = turns - std::floor(turns);
  return static_cast<std::uint8_t>(kHalf + std::min(kHalf - 1, static_cast<int>(part * kHalf)));
}

ColourOverlay::ColourOverlay(const Scene& scene, const SignalChain& chain, const Overlay& ticks,
                             double nyquist_m_s)
    : scene_(scene),
      chain_(chain),
      ticks_(ticks),
      nyquist_m_s_(nyquist_m_s),
      width_(scene.output.width + scene.output.width % 2),
      height_(scene.output.height + scene.output.height % 2) {}

void ColourOverlay::drawColours(const DopplerFrame& frame, double white, GreyImage& image) const {
  const std::vector<float>& velocities = frame.measured.velocity_m_s;
  const double least =
      white * intensityFromDecibels(kLeastPower_db - scene_.signal.pictureGain_db());
  Greys shown, cosines, sines;
  for (Greys* plane : {&shown, &cosines, &sines}) plane->resize(velocities.size());
  for (std::size_t i = 0; i < velocities.size(); ++i) {
    const bool is = !std::isnan(velocities[i]) && frame.measured.power[i] >= least;
    const double angle = is ? std::numbers::pi * velocities[i] / nyquist_m_s_ : 0;
    shown[i] = is ? 1 : 0;
    cosines[i] = static_cast<float>(0.5 + (is ? 0.5 * std::cos(angle) : 0));
    sines[i] = static_cast<float>(0.5 + (is ? 0.5 * std::sin(angle) : 0));
  }
  std::vector<float> is, x, y;
  chain_.picture(shown, is);
  chain_.picture(cosines, x);
  chain_.picture(sines, y);
  for (int row = 0; row < scene_.output.height; ++row)
    for (int column = 0; column < scene_.output.width; ++column) {
      const auto from = static_cast<std::size_t>(row * scene_.output.width + column);
      if (is[from] < 0.5f) continue;
      const double angle =
          std::atan2(static_cast<double>(y[from]) - 0.5, static_cast<double>(x[from]) - 0.5);
      image.pixels[static_cast<std::size_t>(row * width_ + column)] =
          colourIndex(angle / std::numbers::pi * nyquist_m_s_, nyquist_m_s_);
    }
}

// A bar on the left edge, v_N at its top and -v_N at its bottom, in cm/s.
void ColourOverlay::drawScale(GreyImage& image) const {
  const int left = std::max(2, width_ / 60), wide = std::max(4, width_ / 50);
  const int top = height_ / 8, high = std::max(2, height_ / 3);
  for (int y = 0; y < high; ++y)
    for (int x = left; x < std::min(left + wide, width_); ++x) {
      const double velocity = nyquist_m_s_ * (1 - 2 * (y + 0.5) / high);
      image.pixels[static_cast<std::size_t>((top + y) * width_ + x)] =
          colourIndex(velocity, nyquist_m_s_);
    }
  cv::Mat canvas(height_, width_, CV_8U, image.pixels.data());
  const double scale = std::max(0.25, 0.4 * height_ / 600.0);
  const auto write = [&](const std::string& text, int y) {
    cv::putText(canvas, text, {left, y}, cv::FONT_HERSHEY_SIMPLEX, scale, kTextIndex);
  };
  constexpr double kCentimetres = 100;
  write(fmt::format("{:.1f} cm/s", kCentimetres * nyquist_m_s_), top - 4);
  write(fmt::format("-{:.1f}", kCentimetres * nyquist_m_s_),
        top + high + static_cast<int>(30 * scale));
}

GreyImage ColourOverlay::draw(const DopplerFrame& frame, double white, double loop_position) const {
  GreyImage grey;
  chain_.picture(frame.greys, grey);
  ticks_.draw(grey, loop_position);
  GreyImage image{width_, height_, {}};
  image.pixels.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (int y = 0; y < grey.height; ++y)
    for (int x = 0; x < grey.width; ++x)
      image.pixels[static_cast<std::size_t>(y * width_ + x)] =
          grey.pixels[static_cast<std::size_t>(y * grey.width + x)] / 2;
  drawColours(frame, white, image);
  drawScale(image);
  return image;
}

}  // namespace echocine
