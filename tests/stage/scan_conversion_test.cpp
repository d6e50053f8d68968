// From beam space to pixels.

#include "signal/scan_conversion.h"
#include "scene/scan_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

Scene sceneOf(ProbeKind kind, int lines, int samples) {
  Scene scene = plainScene({medium("m", 1000, 1500)});
  Probe& p = scene.probe;
  p.kind = kind;
  p.lines = lines;
  p.samples = samples;
  p.min_depth_m = 0.01;
  if (kind == ProbeKind::curvilinear) p.face_radius_m = 0.05;
  if (kind == ProbeKind::linear) {
    p.first_angle_rad = p.last_angle_rad = 0;
    p.first_offset_m = -0.03;
    p.last_offset_m = 0.03;
  }
  return scene;
}

GreyCurve gammaOf(double gamma) {
  SignalSettings signal;
  signal.grey_gamma = gamma;
  return GreyCurve(signal);
}

struct Converted {
  Scene scene;
  PictureGeometry geometry = pictureGeometry(scene);
  ScanConverter converter{scene.probe, geometry, scene.output.width, scene.output.height,
                          GreyCurve()};

  GreyImage image(const std::vector<float>& grey) const {
    GreyImage result;
    converter.convert(grey, result);
    return result;
  }
  std::vector<float> plane(float value) const {
    return std::vector<float>(static_cast<std::size_t>(scene.probe.lines * scene.probe.samples),
                              value);
  }
  // Where a sample's centre lies in the picture, in pixels.
  std::pair<double, double> place(int line, int sample) const {
    const LineGeometry l = lineGeometry(scene.probe, line);
    const double depth_m = scene.probe.min_depth_m + (sample + 0.5) * scene.probe.sampleSpacing();
    const Vec3d p = l.origin + depth_m * l.direction;
    return {geometry.origin_x_px + p.x / geometry.metres_per_pixel,
            geometry.origin_y_px + p.z / geometry.metres_per_pixel};
  }
};

// Centroid of the grey values, in pixels with their centres at halves.
std::pair<double, double> centroid(const GreyImage& image) {
  double sum = 0, x = 0, y = 0;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const double v = image.pixels[static_cast<std::size_t>(row * image.width + column)];
      sum += v;
      x += v * (column + 0.5);
      y += v * (row + 0.5);
    }
  return {x / sum, y / sum};
}

constexpr ProbeKind kProbeKinds[] = {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear};

// Against the geometry by hand, for all kinds of probes.
TEST(ScanConversion, ABrightSampleLandsOnItsPixelWithinHalfAPixel) {
  for (const ProbeKind kind : kProbeKinds) {
    const Converted c{sceneOf(kind, 161, 201)};
    for (const auto& [line, sample] : {std::pair(80, 100), {20, 180}, {140, 60}, {7, 120}}) {
      std::vector<float> grey = c.plane(0);
      grey[static_cast<std::size_t>(line * 201 + sample)] = 1;
      const auto [x, y] = centroid(c.image(grey));
      EXPECT_NEAR(x, c.place(line, sample).first, 0.5);
      EXPECT_NEAR(y, c.place(line, sample).second, 0.5);
    }
  }
}

// Is a pixel's centre in the scan area, by a margin in metres?
bool inside(const Scene& scene, double x_m, double z_m, double margin) {
  const Probe& p = scene.probe;
  if (p.kind == ProbeKind::linear)
    return std::abs(x_m) <= 0.03 + margin && z_m >= p.min_depth_m - margin &&
           z_m <= p.max_depth_m + margin;
  const double r = std::hypot(x_m, z_m) - p.face_radius_m;
  const double side = (std::abs(std::atan2(x_m, z_m)) - p.last_angle_rad) * std::hypot(x_m, z_m);
  return r >= p.min_depth_m - margin && r <= p.max_depth_m + margin && side <= margin;
}

// Exactly 0 outside: readers find the sector by it.
TEST(ScanConversion, InsideIsFilledAndOutsideIsExactlyBlack) {
  for (const ProbeKind kind : kProbeKinds) {
    const Converted c{sceneOf(kind, 33, 50)};
    const GreyImage image = c.image(c.plane(1));
    for (int row = 0; row < image.height; ++row)
      for (int column = 0; column < image.width; ++column) {
        const double x_m = (column + 0.5 - c.geometry.origin_x_px) * c.geometry.metres_per_pixel;
        const double z_m = (row + 0.5 - c.geometry.origin_y_px) * c.geometry.metres_per_pixel;
        const int value = image.pixels[static_cast<std::size_t>(row * image.width + column)];
        if (inside(c.scene, x_m, z_m, -1e-9)) {
          ASSERT_EQ(value, 255);
        }
        if (!inside(c.scene, x_m, z_m, 1e-9)) {
          ASSERT_EQ(value, 0);
        }
      }
  }
}

TEST(ScanConversion, TheWholeScanAreaIsInThePictureAboveTheEcg) {
  for (const ProbeKind kind : kProbeKinds) {
    const Converted c{sceneOf(kind, 33, 50)};
    for (const int line : {0, 16, 32})
      for (const int sample : {0, 49}) {
        const auto [x, y] = c.place(line, sample);
        EXPECT_TRUE(x > 0 && x < 800 && y > 0 && y < 600 - c.geometry.ecg_strip_px);
      }
  }
}

TEST(ScanConversion, AGreyRampIsInterpolatedWithoutSteps) {
  const Converted c{sceneOf(ProbeKind::linear, 11, 3)};
  std::vector<float> grey = c.plane(0);
  for (int line = 0; line < 11; ++line)
    for (int k = 0; k < 3; ++k)
      grey[static_cast<std::size_t>(line * 3 + k)] = static_cast<float>(line) / 10;
  const GreyImage image = c.image(grey);
  const int row = static_cast<int>(c.place(5, 1).second);
  for (int column = 0; column < image.width; ++column) {
    const double t =
        ((column + 0.5 - c.geometry.origin_x_px) * c.geometry.metres_per_pixel + 0.03) / 0.06;
    if (t < 0 || t > 1) continue;
    ASSERT_NEAR(image.pixels[static_cast<std::size_t>(row * image.width + column)], 255 * t, 0.6);
  }
}

TEST(ScanConversion, OneLineOrOneSampleFillTheScanArea) {
  for (const ProbeKind kind : kProbeKinds)
    for (const auto& [lines, samples] : {std::pair(1, 40), {40, 1}, {1, 1}}) {
      const Converted c{sceneOf(kind, lines, samples)};
      const GreyImage image = c.image(c.plane(0.5f));
      const auto filled = std::count(image.pixels.begin(), image.pixels.end(), 128);
      EXPECT_GT(filled, 1000);
      EXPECT_EQ(std::count(image.pixels.begin(), image.pixels.end(), 0) + filled, 800 * 600);
    }
}

TEST(ScanConversion, GammaIsTheLastStep) {
  const Scene scene = sceneOf(ProbeKind::linear, 3, 3);
  const ScanConverter converter(scene.probe, pictureGeometry(scene), 800, 600, gammaOf(2));
  GreyImage image;
  converter.convert(std::vector<float>(9, 0.5f), image);
  EXPECT_EQ(*std::max_element(image.pixels.begin(), image.pixels.end()), 64);
}

// A small picture of a fine grid: each pixel spans several samples and lines.
struct Small {
  explicit Small(int size) : scene(sceneOf(ProbeKind::phased, 192, 1024)) {
    scene.output.width = scene.output.height = size;
    scene.output.ecg = false;
    geometry = pictureGeometry(scene);
    averaged = ScanConverter::averagedOver(scene, geometry);
  }
  std::vector<float> picture(const std::vector<float>& grey, int over) const {
    const ScanConverter converter(scene.probe, geometry, scene.output.width, scene.output.height,
                                  GreyCurve(), over);
    std::vector<float> values;
    converter.convert(grey, values);
    return values;
  }
  std::vector<float> plane(auto&& grey) const {
    std::vector<float> values;
    for (int line = 0; line < scene.probe.lines; ++line)
      for (int k = 0; k < scene.probe.samples; ++k) values.push_back(grey(line, k));
    return values;
  }
  Scene scene;
  PictureGeometry geometry;
  int averaged = 1;
};

TEST(ScanConversion, OnlyPicturesCoarserThanAnEchoAreAveraged) {
  EXPECT_GT(Small(112).averaged, 4);
  EXPECT_EQ(Small(1200).averaged, 1);
  Small slow(112);  // an echo as long as a pixel
  slow.scene.signal.pulse_cycles =
      2 * slow.geometry.metres_per_pixel / ScanGeometry(slow.scene.probe).wavelength() * 1.01;
  EXPECT_EQ(ScanConverter::averagedOver(slow.scene, slow.geometry), 1);
}

TEST(ScanConversion, AnAveragedPictureKeepsAConstantAndItsOutline) {
  const Small small(112);
  const std::vector<float> grey = small.plane([](int, int) { return 0.375f; });
  const std::vector<float> mean = small.picture(grey, small.averaged),
                           centre = small.picture(grey, 1);
  for (std::size_t i = 0; i < mean.size(); ++i) EXPECT_EQ(mean[i], centre[i]) << i;
}

// Law: samples bright and dark by turns have no structure that a pixel of ten samples could show.
// Centres alone give whatever they meet.
TEST(ScanConversion, AFineGratingBecomesItsMean) {
  const Small small(112);
  const std::vector<float> grey = small.plane([](int, int k) { return k % 2 == 0 ? 1.0f : 0.0f; });
  const auto furthest = [&](int over) {
    const std::vector<float> values = small.picture(grey, over);
    const int size = small.scene.output.width;
    float most = 0;
    // Pixels that lie wholly in the scan area: each neighbour is in it, too.
    for (int y = 1; y + 1 < size; ++y)
      for (int x = 1; x + 1 < size; ++x) {
        bool inside = true;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            inside = inside && values[static_cast<std::size_t>((y + dy) * size + x + dx)] >= 0;
        const float value = values[static_cast<std::size_t>(y * size + x)];
        if (inside) most = std::max(most, std::abs(value - 0.5f));
      }
    return most;
  };
  EXPECT_LT(furthest(small.averaged), 0.1f);
  EXPECT_GT(furthest(1), 0.4f);
}

// Law: the mean over the scan area is that of a picture with as many pixels as values are averaged,
// but for the pixels at its outline.
TEST(ScanConversion, AveragingKeepsTheMean) {
  const Small small(112), large(112 * small.averaged);
  const std::vector<float> grey = small.plane([](int line, int k) {
    return 0.5f + 0.3f * std::sin(0.2f * static_cast<float>(line)) *
                      std::cos(0.013f * static_cast<float>(k));
  });
  const auto meanOf = [](const std::vector<float>& picture) {
    double sum = 0, count = 0;
    for (const float value : picture)
      if (value >= 0) {
        sum += static_cast<double>(value);
        ++count;
      }
    return sum / count;
  };
  EXPECT_NEAR(meanOf(small.picture(grey, small.averaged)), meanOf(large.picture(grey, 1)), 2e-3);
}

TEST(ScanConversion, AveragedGreysAreTheMeanThroughTheGreyMap) {
  const Small small(112);
  const std::vector<float> grey = small.plane(
      [](int line, int k) { return static_cast<float>((line * 7 + k * 13) % 101) / 100; });
  const ScanConverter converter(small.scene.probe, small.geometry, 112, 112, gammaOf(2),
                                small.averaged);
  GreyImage image;
  std::vector<float> values;
  converter.convert(grey, image);
  converter.convert(grey, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double wanted = values[i] < 0 ? 0 : 255 * std::pow(static_cast<double>(values[i]), 2);
    ASSERT_NEAR(image.pixels[i], wanted, 0.6) << i;
  }
}

}  // namespace
}  // namespace echocine
