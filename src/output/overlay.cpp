#include "output/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/check.h"
#include "scene/scan_geometry.h"

namespace echocine {
namespace {

// Greys of the furniture: below the bright parts of the image, so that the eye stays there.
constexpr int kTickGrey = 180, kLabelGrey = 200, kTraceGrey = 150, kCursorGrey = 70, kDotGrey = 255;

// OpenCV draws at 1/16 pixel when coordinates carry four fractional bits.
constexpr int kSubpixelBits = 4;
cv::Point subpixel(cv::Point2d p) {
  const double scale = 1 << kSubpixelBits;
  return {static_cast<int>(std::lround(p.x * scale)), static_cast<int>(std::lround(p.y * scale))};
}

// Lengths below are pixels of a picture 600 rows high and grow with it.
double sizeUnit(int height) {
  return std::max(0.6, height / 600.0);
}

struct Label {
  std::string text;
  double font_scale = 1;
  cv::Size size;

  Label(std::string words, double unit) : text(std::move(words)), font_scale(0.42 * unit) {
    int below_baseline = 0;
    size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, font_scale, 1, &below_baseline);
  }
  void draw(cv::Mat& canvas, cv::Point2d centre) const {
    const cv::Point corner(static_cast<int>(std::lround(centre.x - 0.5 * size.width)),
                           static_cast<int>(std::lround(centre.y + 0.5 * size.height)));
    cv::putText(canvas, text, corner, cv::FONT_HERSHEY_SIMPLEX, font_scale, kLabelGrey, 1,
                cv::LINE_AA);
  }
};

// Enough lines for their ends to form the sector's arcs; the scene may have a single one.
Probe withDenseLines(Probe probe) {
  probe.lines = 257;
  return probe;
}

cv::Point2d inPicture(const PictureGeometry& geometry, const LineGeometry& line, double depth_m) {
  const Vec3d point = line.origin + depth_m * line.direction;
  return {geometry.origin_x_px + point.x / geometry.metres_per_pixel,
          geometry.origin_y_px + point.z / geometry.metres_per_pixel};
}

// The line along which depths are marked: the right edge of the sector; of a full turn a line
// beside the circle, from the height of the face downwards.
LineGeometry markedLine(const Probe& probe) {
  if (probe.isFullTurn())
    return {{probe.face_radius_m + probe.max_depth_m, 0, probe.face_radius_m}, {0, 0, 1}};
  const Probe dense = withDenseLines(probe);
  return lineGeometry(dense, dense.lines - 1);
}

// Ticks point away from the sector, one per centimetre; every fifth is longer and numbered, the
// deepest number with its unit.
void drawDepthTicks(cv::Mat& canvas, const Probe& probe, const PictureGeometry& geometry) {
  constexpr double kCentimetre = 0.01, kTolerance = 1e-9, kLeastPixelsApart = 4;
  const double unit = sizeUnit(canvas.rows);
  const LineGeometry edge = markedLine(probe);
  const cv::Point2d outward(edge.direction.z, -edge.direction.x);
  const int free_rows = canvas.rows - geometry.ecg_strip_px;

  const int deepest = static_cast<int>(std::floor(probe.max_depth_m / kCentimetre + kTolerance));
  const int long_step = deepest >= 5 ? 5 : 1;
  // Ticks nearer than 4 pixels run together; then only those with numbers are drawn.
  const bool crowded = kCentimetre / geometry.metres_per_pixel < kLeastPixelsApart * unit;
  const int step = crowded ? long_step : 1;
  for (int cm = step; cm <= deepest; cm += step) {
    const double depth_m = cm * kCentimetre;
    if (depth_m < probe.min_depth_m - kTolerance) continue;
    const bool numbered = cm % long_step == 0;
    const cv::Point2d on_edge = inPicture(geometry, edge, depth_m);
    const cv::Point2d from = on_edge + 4 * unit * outward;
    const cv::Point2d to = from + (numbered ? 11 : 5) * unit * outward;
    cv::line(canvas, subpixel(from), subpixel(to), kTickGrey, 1, cv::LINE_AA, kSubpixelBits);
    if (!numbered) continue;
    const Label label(std::to_string(cm) + (cm + long_step > deepest ? " cm" : ""), unit);
    const double reach =
        0.5 * (label.size.width * std::abs(outward.x) + label.size.height * std::abs(outward.y));
    const cv::Point2d centre = to + (5 * unit + reach) * outward;
    const cv::Rect2d room(0, 0, canvas.cols, free_rows);
    const cv::Point2d half(0.5 * label.size.width + 1, 0.5 * label.size.height + 1);
    if (room.contains(centre - half) && room.contains(centre + half)) label.draw(canvas, centre);
  }
}

// Nothing of the overlay may cover the image, whatever the shape of the sector.
void clearSector(cv::Mat& canvas, const Probe& probe, const PictureGeometry& geometry) {
  const Probe dense = withDenseLines(probe);
  std::vector<cv::Point> near, far;
  for (int line = 0; line < dense.lines; ++line) {
    const LineGeometry at = lineGeometry(dense, line);
    near.push_back(subpixel(inPicture(geometry, at, dense.min_depth_m)));
    far.push_back(subpixel(inPicture(geometry, at, dense.max_depth_m)));
  }
  std::vector<std::vector<cv::Point>> outline{near, far};  // of a full turn: what is between both
  if (!probe.isFullTurn()) {
    outline[0].insert(outline[0].end(), far.rbegin(), far.rend());
    outline.pop_back();
  }
  cv::fillPoly(canvas, outline, 0, cv::LINE_8, kSubpixelBits);
}

// Where the trace runs in the picture.
struct TraceArea {
  double left, right, top, bottom;  // px, of the trace's extremes
  double lowest = 0, highest = 1;   // the amplitudes there

  cv::Point2d at(double loop_position, double amplitude) const {
    const double height = (amplitude - lowest) / (highest - lowest);
    return {left + loop_position * (right - left), bottom - height * (bottom - top)};
  }
};

// The trace always holds the range from 0 to 1, so that a flat lead is drawn flat and not blown up.
TraceArea traceArea(const std::vector<double>& ecg, cv::Rect strip, const Label& rate,
                    double unit) {
  const double margin = 10 * unit;
  const double above = std::max(4 * unit, 0.12 * strip.height);
  TraceArea area{strip.x + margin, strip.x + strip.width - rate.size.width - 2.5 * margin,
                 strip.y + above, strip.y + strip.height - above};
  const auto [least, greatest] = std::minmax_element(ecg.begin(), ecg.end());
  area.lowest = std::min(0.0, *least);
  area.highest = std::max(1.0, *greatest);
  return area;
}

double between(const std::vector<double>& ecg, double loop_position) {
  const double place = loop_position * static_cast<double>(ecg.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), ecg.size() - 1);
  const std::size_t after = std::min(before + 1, ecg.size() - 1);
  return std::lerp(ecg[before], ecg[after], place - static_cast<double>(before));
}

void drawTrace(cv::Mat& canvas, const std::vector<double>& ecg, const TraceArea& area) {
  std::vector<cv::Point> points;
  for (std::size_t i = 0; i < ecg.size(); ++i) {
    const double last = static_cast<double>(std::max<std::size_t>(ecg.size() - 1, 1));
    points.push_back(subpixel(area.at(static_cast<double>(i) / last, ecg[i])));
  }
  cv::polylines(canvas, points, false, kTraceGrey, 1, cv::LINE_AA, kSubpixelBits);
}

// Calls visit(x, y, grey) for what was drawn on a canvas.
template <typename Visit>
void forEachDrawn(const cv::Mat& canvas, Visit visit) {
  for (int y = 0; y < canvas.rows; ++y)
    for (int x = 0; x < canvas.cols; ++x)
      if (const std::uint8_t grey = canvas.at<std::uint8_t>(y, x); grey > 0) visit(x, y, grey);
}

}  // namespace

Overlay::Overlay(const Scene& scene, const PictureGeometry& geometry,
                 const std::vector<double>& ecg)
    : width_(scene.output.width), height_(scene.output.height) {
  cv::Mat canvas(height_, width_, CV_8UC1, cv::Scalar(0));
  const double unit = sizeUnit(height_);
  if (scene.output.depth_ticks) drawDepthTicks(canvas, scene.probe, geometry);

  const Label rate(fmt::format("{:.0f} bpm", scene.acquisition.heart_rate_hz * 60), unit);
  strip_top_ = height_ - geometry.ecg_strip_px;
  const cv::Rect strip(0, strip_top_, width_, geometry.ecg_strip_px);
  if (scene.output.ecg && !ecg.empty() && strip.height > 0) {
    const TraceArea area = traceArea(ecg, strip, rate, unit);
    // A picture too small for a trace goes without.
    if (area.right - area.left >= 16 * unit && area.bottom - area.top >= 6 * unit) {
      drawTrace(canvas, ecg, area);
      rate.draw(canvas, {width_ - 10 * unit - 0.5 * rate.size.width, strip.y + 0.5 * strip.height});
      first_column_ = static_cast<int>(std::lround(area.left));
      const int columns = static_cast<int>(std::lround(area.right)) - first_column_ + 1;
      for (int i = 0; i < columns; ++i) {
        const double position = static_cast<double>(i) / (columns - 1);
        const double row = area.at(position, between(ecg, position)).y;
        trace_row_.push_back(static_cast<int>(std::lround(row)));
      }
    }
  }
  clearSector(canvas, scene.probe, geometry);
  forEachDrawn(canvas, [&](int x, int y, std::uint8_t grey) { still_.push_back({x, y, grey}); });

  const double radius = std::max(2.5, 3 * unit);
  const int centre = static_cast<int>(std::ceil(radius)) + 1;
  cv::Mat dot(2 * centre + 1, 2 * centre + 1, CV_8UC1, cv::Scalar(0));
  cv::circle(dot, subpixel(cv::Point2d(centre, centre)), subpixel({radius, 0}).x, kDotGrey,
             cv::FILLED, cv::LINE_AA, kSubpixelBits);
  forEachDrawn(dot, [&](int x, int y, std::uint8_t grey) {
    dot_.push_back({x - centre, y - centre, grey});
  });
}

void Overlay::draw(GreyImage& image, double loop_position) const {
  CHECK_EQ(image.width, width_);
  CHECK_EQ(image.height, height_);
  const auto brighten = [&](int x, int y, int grey) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
    std::uint8_t& pixel = image.pixels[static_cast<std::size_t>(y) * width_ + x];
    pixel = std::max(pixel, static_cast<std::uint8_t>(grey));
  };
  for (const Stroke& stroke : still_) brighten(stroke.x, stroke.y, stroke.grey);
  if (trace_row_.empty()) return;
  const double last = static_cast<double>(trace_row_.size() - 1);
  const int column = static_cast<int>(std::lround(std::clamp(loop_position, 0.0, 1.0) * last));
  const int x = first_column_ + column;
  for (int y = strip_top_; y < height_; ++y) brighten(x, y, kCursorGrey);
  for (const Stroke& part : dot_)
    brighten(x + part.x, trace_row_[static_cast<std::size_t>(column)] + part.y, part.grey);
}

}  // namespace echocine
