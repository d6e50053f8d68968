// Ticks, numbers and ECG strip stand where they should and never on the sector.

#include "output/overlay.h"

#include <cmath>

#include "output_fixture.h"

namespace echocine {
namespace {

constexpr int kStripRows = 48;

struct Setting {
  Scene scene = test::smallScene();
  PictureGeometry geometry;

  explicit Setting(ProbeKind kind) {
    scene.output.width = 800;
    scene.output.height = 600;
    scene.probe.kind = kind;
    geometry = {400, 12, 0.16 / 520, kStripRows};
    if (kind == ProbeKind::curvilinear) {
      scene.probe.face_radius_m = 0.05;
      geometry = {400, -100, 0.16 / 500, kStripRows};
    }
    if (kind == ProbeKind::linear) {
      scene.probe.first_angle_rad = scene.probe.last_angle_rad = 0;
      scene.probe.first_offset_m = -0.03;
      scene.probe.last_offset_m = 0.03;
      scene.probe.max_depth_m = 0.12;
      geometry = {400, 12, 0.12 / 520, kStripRows};
    }
  }

  // Whether the centre of a pixel lies in the sector.
  bool inSector(int x, int y) const {
    const Probe& probe = scene.probe;
    const double lateral = (x - geometry.origin_x_px) * geometry.metres_per_pixel;
    const double depth = (y - geometry.origin_y_px) * geometry.metres_per_pixel;
    if (probe.kind == ProbeKind::linear)
      return lateral >= probe.first_offset_m && lateral <= probe.last_offset_m &&
             depth >= probe.min_depth_m && depth <= probe.max_depth_m;
    const double along = std::hypot(lateral, depth) - probe.face_radius_m;
    const double angle = std::atan2(lateral, depth);
    return along >= probe.min_depth_m && along <= probe.max_depth_m &&
           angle >= probe.first_angle_rad && angle <= probe.last_angle_rad;
  }

  GreyImage drawn(const std::vector<double>& ecg, double loop_position, int grey = 0) const {
    GreyImage image{800, 600,
                    std::vector<std::uint8_t>(800 * 600, static_cast<std::uint8_t>(grey))};
    Overlay(scene, geometry, ecg).draw(image, loop_position);
    return image;
  }
};

int at(const GreyImage& image, int x, int y) {
  return image.pixels[static_cast<std::size_t>(y * image.width + x)];
}

int brightPixels(const GreyImage& image, int first_row, int last_row) {
  int count = 0;
  for (int y = first_row; y < last_row; ++y)
    for (int x = 0; x < image.width; ++x) count += at(image, x, y) > 0 ? 1 : 0;
  return count;
}

// A single R wave in the middle of the loop.
std::vector<double> oneWave() {
  std::vector<double> ecg(101, 0.0);
  ecg[50] = 1.0;
  return ecg;
}

TEST(Overlay, NeverTouchesTheSectorAndStandsBesideIt) {
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear}) {
    const Setting setting(kind);
    const GreyImage image = setting.drawn(oneWave(), 0.3);
    for (int y = 0; y < image.height - kStripRows; ++y)
      for (int x = 0; x < image.width; ++x)
        ASSERT_TRUE(at(image, x, y) == 0 || !setting.inSector(x, y)) << x << ' ' << y;
    EXPECT_GT(brightPixels(image, 0, 600 - kStripRows), 200);
    EXPECT_GT(brightPixels(image, 600 - kStripRows, 600), 400);
  }
}

TEST(Overlay, TicksOfALinearProbeStandAtEveryCentimetreLongerAtEveryFifth) {
  const Setting setting(ProbeKind::linear);
  const GreyImage image = setting.drawn({}, 0);
  const int edge = static_cast<int>(400 + 0.03 / setting.geometry.metres_per_pixel);
  for (int cm = 1; cm <= 12; ++cm) {
    const int row = static_cast<int>(std::lround(12 + 0.01 * cm / (0.12 / 520)));
    const auto reached = [&](int x) {
      return at(image, x, row - 1) + at(image, x, row) + at(image, x, row + 1);
    };
    EXPECT_GT(reached(edge + 7), 80) << cm;
    if (cm % 5 == 0)
      EXPECT_GT(reached(edge + 13), 80) << cm;
    else
      EXPECT_EQ(reached(edge + 13), 0) << cm;
  }
}

TEST(Overlay, BrighterPixelsOfTheImageStay) {
  const Setting setting(ProbeKind::phased);
  const GreyImage image = setting.drawn(oneWave(), 0.5, 254);
  for (const std::uint8_t grey : image.pixels) ASSERT_GE(grey, 254);
}

TEST(Overlay, CursorMovesFromLeftToRightOnTheTrace) {
  const Setting setting(ProbeKind::phased);
  const auto cursor = [&](double position) {
    const GreyImage image = setting.drawn(oneWave(), position);
    double x_sum = 0, y_sum = 0, count = 0;
    for (int y = 600 - kStripRows; y < 600; ++y)
      for (int x = 0; x < 800; ++x)
        if (at(image, x, y) == 255) x_sum += x, y_sum += y, count += 1;
    return std::pair(x_sum / count, y_sum / count);
  };
  double previous = 0;
  for (const double position : {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    const auto [x, y] = cursor(position);
    EXPECT_GT(x, previous);
    previous = x;
  }
  EXPECT_NEAR(cursor(0.5).first, 0.5 * (cursor(0).first + cursor(1).first), 1.0);
  EXPECT_LT(cursor(0.5).second, cursor(0.2).second - 20) << "the R wave points up";
}

TEST(Overlay, NothingIsDrawnWhenNothingIsWanted) {
  Setting setting(ProbeKind::phased);
  setting.scene.output.ecg = setting.scene.output.depth_ticks = false;
  EXPECT_EQ(brightPixels(setting.drawn(oneWave(), 0.5), 0, 600), 0);
  setting.scene.output.depth_ticks = true;
  EXPECT_EQ(brightPixels(setting.drawn({}, 0.5), 600 - kStripRows, 600), 0);
}

TEST(Overlay, AnyPictureHoldsItOrGoesWithout) {
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear})
    for (const int width : {1, 16, 64, 200, 3000})
      for (const int strip : {0, 1, 10, 100}) {
        Setting setting(kind);
        setting.scene.probe.lines = 1;
        setting.scene.output.width = width;
        setting.scene.output.height = 120;
        setting.geometry = {0.5 * width, 1, 0.16 / 100, strip};
        GreyImage image{width, 120,
                        std::vector<std::uint8_t>(static_cast<std::size_t>(width) * 120)};
        for (const std::vector<double>& ecg : {oneWave(), {}, {0.7}, {0.0, 0.0}}) {
          const Overlay overlay(setting.scene, setting.geometry, ecg);
          for (const double position : {0.0, 1.0}) overlay.draw(image, position);
        }
      }
}

}  // namespace
}  // namespace echocine
