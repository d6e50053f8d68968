#include "mmode/mmode_picture.h"

#include <algorithm>
#include <cmath>

#include "motion/cycle/ecg.h"
#include "scene/grey_curve.h"

namespace echocine {

namespace {

// Greys of ticks and trace, and rows below the echoes; our choice.
constexpr std::uint8_t kTickGrey = 180, kTraceGrey = 150;
constexpr int kTickRows = 14, kEcgRows = 60, kTickColumns = 14;

class Canvas {
 public:
  Canvas(int width, int height) {
    image.width = width;
    image.height = height;
    image.pixels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  }
  void set(int x, int y, std::uint8_t grey) {
    if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
    image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                 static_cast<std::size_t>(x)] = grey;
  }
  GreyImage image;
};

void drawEchoes(const MMode& mode, const Scene& scene, int rows, Canvas& canvas) {
  const GreyCurve curve(scene.signal);
  for (int t = 0; t < mode.columns; ++t)
    for (int y = 0; y < rows; ++y) {
      const double at = std::clamp((y + 0.5) * mode.samples / rows - 0.5, 0.0, mode.samples - 1.0);
      const auto k = std::min(static_cast<int>(at), std::max(mode.samples - 2, 0));
      const auto first = static_cast<std::size_t>(t) * static_cast<std::size_t>(mode.samples) +
                         static_cast<std::size_t>(k);
      const double next = mode.samples > 1 ? mode.greys[first + 1] : mode.greys[first];
      const double grey = mode.greys[first] + (at - k) * (next - mode.greys[first]);
      canvas.set(t, y, static_cast<std::uint8_t>(std::lround(255 * curve.at(grey))));
    }
}

void drawTicks(const MMode& mode, const Probe& probe, double rate_hz, int rows, Canvas& canvas) {
  const double row_m = (probe.max_depth_m - probe.min_depth_m) / rows;
  for (int cm = 1; cm * 0.01 <= probe.max_depth_m; ++cm) {
    const int y = static_cast<int>(std::floor((cm * 0.01 - probe.min_depth_m) / row_m));
    for (int x = 0; y >= 0 && y < rows && x < (cm % 5 == 0 ? 12 : 6); ++x)
      canvas.set(mode.columns + 1 + x, y, kTickGrey);
  }
  for (int tenth = 0; tenth * 0.1 * rate_hz < mode.columns; ++tenth)
    for (int y = 0; y < (tenth % 5 == 0 ? 12 : 6); ++y)
      canvas.set(static_cast<int>(std::lround(tenth * 0.1 * rate_hz)), rows + 1 + y, kTickGrey);
}

// The lead from -0.3 to 1.1 of the R wave, joined from column to column.
void drawEcg(const MMode& mode, int top, Canvas& canvas) {
  int before = -1;
  for (int t = 0; t < mode.columns; ++t) {
    const FrameTime& time = mode.times[static_cast<std::size_t>(t)];
    const double lead = ecgAmplitude(time.time_in_beat_s, time.beat_s);
    const int y = top + static_cast<int>(std::lround((1.1 - lead) / 1.4 * (kEcgRows - 1)));
    const int from = before < 0 ? y : before;
    for (int row = std::min(from, y); row <= std::max(from, y); ++row)
      canvas.set(t, row, kTraceGrey);
    before = y;
  }
}

}  // namespace

GreyImage mmodePicture(const MMode& mode, const Scene& scene, double rate_hz, int rows) {
  const bool ticks = scene.output.depth_ticks, ecg = scene.output.ecg;
  const int below = (ticks ? kTickRows : 0) + (ecg ? kEcgRows : 0);
  Canvas canvas(mode.columns + (ticks ? kTickColumns : 0), rows + below);
  drawEchoes(mode, scene, rows, canvas);
  if (ticks) drawTicks(mode, scene.probe, rate_hz, rows, canvas);
  if (ecg) drawEcg(mode, rows + (ticks ? kTickRows : 0), canvas);
  return std::move(canvas.image);
}

}  // namespace echocine
