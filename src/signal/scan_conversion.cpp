#include "signal/scan_conversion.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace echocine {

namespace {

constexpr int kGreySteps = 4096;  // of the grey map: sixteen per grey level

struct Area {
  double x_lo = 0, x_hi = 0, z_lo = 0, z_hi = 0;
  void add(Vec3d p) {
    x_lo = std::min(x_lo, p.x);
    x_hi = std::max(x_hi, p.x);
    z_lo = std::min(z_lo, p.z);
    z_hi = std::max(z_hi, p.z);
  }
};

Area scanArea(const Probe& probe) {
  constexpr int kSteps = 257;  // odd: the middle line reaches deepest
  const LineGeometry first = lineGeometry(probe, 0);
  Area area{first.origin.x, first.origin.x, first.origin.z, first.origin.z};
  Probe outline = probe;
  outline.lines = kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const LineGeometry line = lineGeometry(outline, i);
    area.add(line.origin + probe.min_depth_m * line.direction);
    area.add(line.origin + probe.max_depth_m * line.direction);
  }
  return area;
}

// Position of a point among the lines (0..lines-1) and its path length; nothing outside the lines.
struct BeamPosition {
  double line, path_m;
};

std::optional<BeamPosition> beamPosition(const Probe& probe, double x_m, double z_m) {
  const double last = probe.lines - 1;
  double t = 0, path_m = 0;
  if (probe.kind == ProbeKind::linear) {
    t = (x_m - probe.first_offset_m) / (probe.last_offset_m - probe.first_offset_m);
    path_m = z_m;
  } else {
    const double angle = std::atan2(x_m, z_m);
    t = (angle - probe.first_angle_rad) / (probe.last_angle_rad - probe.first_angle_rad);
    path_m = std::hypot(x_m, z_m) - probe.face_radius_m;
  }
  if (!(t >= 0 && t <= 1)) return std::nullopt;
  return BeamPosition{t * last, path_m};
}

}  // namespace

PictureGeometry pictureGeometry(const Scene& scene) {
  const OutputSettings& o = scene.output;
  PictureGeometry g;
  g.ecg_strip_px = o.ecg && (o.cine || o.png) ? o.height / 8 : 0;
  const double margin = 0.02 * o.height;
  const double tick_room =
      o.depth_ticks ? 0.05 * o.width : 0;  // on both sides, so the sector stays centred
  const Area area = scanArea(scene.probe);
  const double wide = o.width - 2 * margin - 2 * tick_room;
  const double high = o.height - g.ecg_strip_px - 2 * margin;
  g.metres_per_pixel = std::max((area.x_hi - area.x_lo) / wide, (area.z_hi - area.z_lo) / high);
  if (g.metres_per_pixel <= 0) g.metres_per_pixel = scene.probe.max_depth_m / high;
  g.origin_x_px = o.width / 2.0 - (area.x_lo + area.x_hi) / 2 / g.metres_per_pixel;
  g.origin_y_px = margin + high / 2 - (area.z_lo + area.z_hi) / 2 / g.metres_per_pixel;
  return g;
}

ScanConverter::ScanConverter(const Probe& probe, const PictureGeometry& geometry, int width,
                             int height, double grey_gamma)
    : width_(width),
      height_(height),
      next_line_(probe.lines > 1 ? static_cast<std::size_t>(probe.samples) : 0),
      next_sample_(probe.samples > 1 ? 1 : 0) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      addPixel(probe, y * width + x, (x + 0.5 - geometry.origin_x_px) * geometry.metres_per_pixel,
               (y + 0.5 - geometry.origin_y_px) * geometry.metres_per_pixel);
  for (int i = 0; i <= kGreySteps; ++i)
    grey_map_.push_back(static_cast<std::uint8_t>(
        std::lround(255 * std::pow(static_cast<double>(i) / kGreySteps, grey_gamma))));
}

void ScanConverter::addPixel(const Probe& probe, int pixel, double x_m, double z_m) {
  const std::optional<BeamPosition> beam = beamPosition(probe, x_m, z_m);
  if (!beam || beam->path_m < probe.min_depth_m || beam->path_m > probe.max_depth_m) return;
  const auto split = [](double position, int count, float& weight) {
    const double inside = std::clamp(position, 0.0, count - 1.0);
    const double whole = std::min(std::floor(inside), std::max(count - 2.0, 0.0));
    weight = static_cast<float>(inside - whole);
    return static_cast<std::uint32_t>(whole);
  };
  Pixel p{};
  p.pixel = static_cast<std::uint32_t>(pixel);
  const std::uint32_t line = split(beam->line, probe.lines, p.across);
  const std::uint32_t sample = split(
      (beam->path_m - probe.min_depth_m) / probe.sampleSpacing() - 0.5, probe.samples, p.along);
  p.sample = line * static_cast<std::uint32_t>(probe.samples) + sample;
  table_.push_back(p);
}

inline float ScanConverter::valueAt(std::span<const float> grey, const Pixel& p) const {
  const float* left = grey.data() + p.sample;
  const float* right = left + next_line_;
  const float a = left[0] + p.along * (left[next_sample_] - left[0]);
  const float b = right[0] + p.along * (right[next_sample_] - right[0]);
  return a + p.across * (b - a);
}

void ScanConverter::convert(std::span<const float> grey, GreyImage& image) const {
  image.width = width_;
  image.height = height_;
  image.pixels.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (const Pixel& p : table_)
    image.pixels[p.pixel] =
        grey_map_[static_cast<std::size_t>(valueAt(grey, p) * kGreySteps + 0.5f)];
}

void ScanConverter::convert(std::span<const float> grey, std::vector<float>& picture) const {
  picture.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), -1.0f);
  for (const Pixel& p : table_) picture[p.pixel] = valueAt(grey, p);
}

}  // namespace echocine
