#pragma once
// Videos of a beating sector with an ECG drawn beneath it, as scanners do.

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "core/hash_random.h"
#include "support/echo_video.h"
#include "video/video_builder.h"

namespace echocine::support {

enum class EcgKind { sweeping, scrolling, marked };

struct DrawnEcg {
  EcgKind kind = EcgKind::sweeping;
  cv::Scalar colour{0, 255, 0};  // blue, green, red
  double fps = 30, px_per_s = 90;
  int frames = 60;
  std::vector<double>
      r_s;               // R waves, s from the first frame; from before it and after the loop too
  double noise = 0;      // standard deviation over the whole picture, greys
  int jpeg_quality = 0;  // 0: none
  double head_s = 0.9;   // when the sweep's head first stands at the left end; of the loop
  int gap_px = 12;       // that a sweep erases before its head
  bool dot = false;      // at the head of a sweep
  bool drawn = true;
  std::uint64_t seed = 1;
};

// R waves at even steps, from before the loop to its end and after.
inline std::vector<double> evenBeats(double bpm, double first_s) {
  std::vector<double> out;
  for (int i = -12; i < 40; ++i) out.push_back(first_s + 60 / bpm * i);
  return out;
}

// mV about: P, Q, R, S and T waves as Gaussians.
inline double leadAt(const std::vector<double>& r_s, double t_s) {
  double sum = 0.02 * std::sin(2 * 3.14159265358979323846 * 0.25 * t_s);
  for (const double r : r_s) {
    const auto wave = [&](double at_s, double height, double width_s) {
      const double u = (t_s - r - at_s) / width_s;
      if (std::abs(u) < 6) sum += height * std::exp(-0.5 * u * u);
    };
    wave(-0.16, 0.12, 0.022);
    wave(-0.025, -0.12, 0.008);
    wave(0, 1, 0.010);
    wave(0.028, -0.22, 0.009);
    wave(0.24, 0.28, 0.045);
  }
  return sum;
}

inline constexpr int kEcgWidth = 400, kEcgHeight = 330, kEcgLeft = 20, kEcgRight = 380,
                     kEcgTop = 262, kEcgBottom = 318;

inline Drawing ecgPicture(int frames) {
  Drawing d;
  d.width = kEcgWidth;
  d.height = kEcgHeight;
  d.frames = frames;
  d.sector = {200, 5, -0.7, 0.7, 12, 235};
  return d;
}

// Row of the trace at an instant.
inline double ecgRow(const DrawnEcg& e, double t_s) {
  const double base = kEcgBottom - 14, tall = 36;
  return base - tall * leadAt(e.r_s, t_s);
}

// From column a to b, the instant of a column by `instant`.
template <typename Instant>
void drawLead(cv::Mat& bgr, const DrawnEcg& e, double a, double b, const Instant& instant) {
  std::vector<cv::Point> points;
  for (double x = a; x <= b; x += 0.25)
    points.emplace_back(static_cast<int>(std::lround(16 * x)),
                        static_cast<int>(std::lround(16 * ecgRow(e, instant(x)))));
  if (points.size() > 1) cv::polylines(bgr, points, false, e.colour, 1, cv::LINE_AA, 4);
}

inline void drawEcg(cv::Mat& bgr, const DrawnEcg& e, int frame) {
  const double now = frame / e.fps, wide = kEcgRight - kEcgLeft, sweep_s = wide / e.px_per_s;
  if (e.kind == EcgKind::scrolling) {
    drawLead(bgr, e, kEcgLeft, kEcgRight,
             [&](double x) { return now - (kEcgRight - x) / e.px_per_s; });
    return;
  }
  if (e.kind == EcgKind::marked) {  // the whole loop, and what lies about it
    const double from = -e.head_s;
    drawLead(bgr, e, kEcgLeft, kEcgRight,
             [&](double x) { return from + (x - kEcgLeft) / e.px_per_s; });
    const int x = static_cast<int>(std::lround(kEcgLeft + (now - from) * e.px_per_s));
    cv::line(bgr, {x, kEcgTop}, {x, kEcgBottom}, {200, 200, 200}, 1);
    return;
  }
  const double since = now - e.head_s, turns = std::floor(since / sweep_s),
               head = kEcgLeft + (since - turns * sweep_s) * e.px_per_s;
  const double turn_s = e.head_s + turns * sweep_s;
  drawLead(bgr, e, kEcgLeft, head, [&](double x) { return turn_s + (x - kEcgLeft) / e.px_per_s; });
  drawLead(bgr, e, head + e.gap_px, kEcgRight,
           [&](double x) { return turn_s - sweep_s + (x - kEcgLeft) / e.px_per_s; });
  if (e.dot)
    cv::circle(bgr, {int(std::lround(head)), int(std::lround(ecgRow(e, now)))}, 2, e.colour,
               cv::FILLED);
}

// What else pictures show there.
using DrawMore = std::function<void(cv::Mat&, int frame)>;

inline std::vector<cv::Mat> ecgFrames(const DrawnEcg& e, const DrawMore& more = {}) {
  // The sector is the same in all of them.
  static std::vector<PixelPlane> sectors;
  for (int f = static_cast<int>(sectors.size()); f < e.frames; ++f)
    sectors.push_back(drawnFrame(ecgPicture(e.frames), f));
  std::vector<cv::Mat> all =
      coloured({sectors.begin(), sectors.begin() + e.frames}, kEcgWidth, kEcgHeight);
  for (int f = 0; f < e.frames; ++f) {
    cv::Mat& bgr = all[static_cast<std::size_t>(f)];
    if (e.drawn) drawEcg(bgr, e, f);
    if (more) more(bgr, f);
    if (e.noise > 0)
      for (int y = 0; y < bgr.rows; ++y)
        for (int x = 0; x < bgr.cols; ++x) {
          const double n =
              e.noise * normalFromHashes(
                            hashOf(e.seed, std::uint64_t(f), std::uint64_t(y * bgr.cols + x), 3),
                            hashOf(e.seed, std::uint64_t(f), std::uint64_t(y * bgr.cols + x), 4));
          for (int c = 0; c < 3; ++c) {
            std::uint8_t& value = bgr.at<cv::Vec3b>(y, x)[c];
            value = static_cast<std::uint8_t>(std::clamp(std::lround(value + n), 0L, 255L));
          }
        }
    if (e.jpeg_quality > 0) {
      std::vector<std::uint8_t> bytes;
      cv::imencode(".jpg", bgr, bytes, {cv::IMWRITE_JPEG_QUALITY, e.jpeg_quality});
      bgr = cv::imdecode(bytes, cv::IMREAD_COLOR);
    }
  }
  return all;
}

inline Video videoOf(const std::vector<cv::Mat>& frames, double fps) {
  VideoBuilder builder("drawn");
  for (const cv::Mat& bgr : frames) {
    cv::Mat rgb;
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    builder.add(rgb.data, rgb.cols, rgb.rows, static_cast<std::ptrdiff_t>(rgb.step));
  }
  Video video = builder.finish();
  video.rate = {fps, "drawn", true};
  return video;
}

}  // namespace echocine::support
