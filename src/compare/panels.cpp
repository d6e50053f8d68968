#include "compare/panels.h"

#include <algorithm>
#include <cmath>

#include "compare/boundary_bands.h"
#include "echo/frame_blend.h"

namespace echocine::compare {

namespace {

void plot(GreyImage& image, double x, double y, std::uint8_t grey,
          const std::vector<std::uint8_t>& within = {}) {
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  if (i < 0 || j < 0 || i >= image.width || j >= image.height) return;
  const std::size_t at = static_cast<std::size_t>(j) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(i);
  if (within.empty() || within[at] != 0) image.pixels[at] = grey;
}

// `within`: pixels that may be drawn on; empty: all.
void drawLine(GreyImage& image, double x0, double y0, double x1, double y1, std::uint8_t grey,
              const std::vector<std::uint8_t>& within = {}) {
  const int steps = std::max(1, static_cast<int>(2 * std::hypot(x1 - x0, y1 - y0)));
  for (int i = 0; i <= std::min(steps, 20000); ++i)
    plot(image, x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps, grey, within);
}

}  // namespace

PanelMaker::PanelMaker(const Comparison& comparison, int height_px) : c_(comparison) {
  const echo::BeamGrid& g = c_.grid;
  // The sector's box: its corners, and its lowest point where it looks straight down.
  const double x_lo = std::min({g.far * std::sin(g.first_rad), g.near * std::sin(g.first_rad)}),
               x_hi = std::max({g.far * std::sin(g.last_rad), g.near * std::sin(g.last_rad)});
  const double y_lo = g.near * std::min(std::cos(g.first_rad), std::cos(g.last_rad)),
               y_hi = g.first_rad < 0 && g.last_rad > 0
                          ? g.far
                          : g.far * std::max(std::cos(g.first_rad), std::cos(g.last_rad));
  pixels_per_unit_ = (height_px - 8) / (y_hi - y_lo);
  // Even sides: codecs that halve colour need them. Four pixels are left free all round.
  height_ = height_px & ~1;
  width_ =
      std::clamp(static_cast<int>((x_hi - x_lo) * pixels_per_unit_) + 8, 16, 4 * height_px) & ~1;
  left_ = 4 - x_lo * pixels_per_unit_;
  top_ = 4 - y_lo * pixels_per_unit_;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const double u = (x + 0.5 - left_) / pixels_per_unit_,
                   v = (y + 0.5 - top_) / pixels_per_unit_;
      const double line =
          (std::atan2(u, v) - g.first_rad) / (g.last_rad - g.first_rad) * (g.lines - 1);
      const double sample = (std::hypot(u, v) - g.near) / (g.far - g.near) * g.samples - 0.5;
      if (line >= 0 && line <= g.lines - 1 && sample >= -0.5 && sample <= g.samples - 0.5)
        pixels_.push_back({y * width_ + x, static_cast<float>(line), static_cast<float>(sample)});
    }
}

GreyImage PanelMaker::picture(Panel panel, int real_frame) const {
  const auto frame = static_cast<std::size_t>(real_frame);
  const echo::BeamGrid& g = c_.grid;
  const bool paired = c_.frames[frame].synthetic_place >= 0;
  std::vector<float> grey;
  if (panel == Panel::real) {
    grey = c_.real_beams.frames[frame];
  } else if (paired) {
    grey = echo::frameAtPlace(c_.synthetic_beams.frames, c_.frames[frame].synthetic_place,
                              c_.synthetic_beat.frames, c_.time.periodic);
    c_.curve.apply(grey, grey);
    if (panel == Panel::difference)
      for (std::size_t i = 0; i < grey.size(); ++i)
        // Middle grey is no difference; half the difference, so that both signs fit into a byte.
        grey[i] = c_.weights[i] > 0 ? 128 + (grey[i] - c_.real_beams.frames[frame][i]) / 2 : 0;
  } else {
    grey.assign(g.size(), 0);
  }
  GreyImage image{width_, height_,
                  std::vector<std::uint8_t>(
                      static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0)};
  // Beam space is a picture of its own: x the sample, y the line.
  for (const Pixel& p : pixels_)
    image.pixels[static_cast<std::size_t>(p.at)] = static_cast<std::uint8_t>(std::clamp(
        std::lround(echo::greyAt(grey.data(), g.samples, g.lines, p.sample + 0.5, p.line + 0.5)),
        0L, 255L));
  if (bands_ != nullptr && panel != Panel::difference && paired) addContours(real_frame, image);
  return image;
}

// Contours end where the sector does.
void PanelMaker::addContours(int real_frame, GreyImage& image) const {
  std::vector<std::uint8_t> within(image.pixels.size(), 0);
  for (const Pixel& p : pixels_) within[static_cast<std::size_t>(p.at)] = 1;
  for (const Contour& c :
       bands_->contoursAt(c_.frames[static_cast<std::size_t>(real_frame)].synthetic_phase))
    for (std::size_t i = c.closed ? 0 : 1; i < c.points_m.size(); ++i) {
      const Vec3d a = c.points_m[i == 0 ? c.points_m.size() - 1 : i - 1], b = c.points_m[i];
      drawLine(image, left_ + a.x * pixels_per_unit_, top_ + a.z * pixels_per_unit_,
               left_ + b.x * pixels_per_unit_, top_ + b.z * pixels_per_unit_, 255, within);
    }
}

// Precondition: all pictures have one size.
GreyImage PanelMaker::sideBySide(std::span<const GreyImage> pictures) {
  const int width = pictures.front().width, height = pictures.front().height;
  GreyImage all{width * static_cast<int>(pictures.size()), height, {}};
  all.pixels.reserve(static_cast<std::size_t>(all.width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (const GreyImage& one : pictures) {
      const auto row = one.pixels.begin() + static_cast<std::ptrdiff_t>(y) * width;
      all.pixels.insert(all.pixels.end(), row, row + width);
    }
  return all;
}

GreyImage sectorPicture(const echo::EchoLoop& loop) {
  const Video& v = loop.video;
  GreyImage image{v.width, v.height, v.frames.front()};
  for (std::size_t p = 0; p < image.pixels.size(); ++p)
    // The mask is shown in an even grey, so that a user sees which pixels are not compared.
    if (loop.overlay[p] != 0) image.pixels[p] = 160;
  const echo::Sector& s = loop.sector();
  const auto at = [&](double r, double angle) {
    return echo::PicturePoint{s.apex_x + r * std::sin(angle), s.apex_y + r * std::cos(angle)};
  };
  for (const double angle : {s.first_rad, s.last_rad}) {
    const echo::PicturePoint a = at(0, angle), b = at(s.r_max, angle);
    drawLine(image, a.x, a.y, b.x, b.y, 255);
  }
  for (const double r : {s.r_min, s.r_max}) {
    const int steps =
        std::max(8, static_cast<int>(std::min(20000.0, 2 * r * (s.last_rad - s.first_rad))));
    for (int i = 0; i <= steps; ++i) {
      const echo::PicturePoint p = at(r, s.first_rad + (s.last_rad - s.first_rad) * i / steps);
      plot(image, p.x, p.y, 255);
    }
  }
  return image;
}

}  // namespace echocine::compare
