// Bent and straight rays through a stack of flat thin layers with equal speeds before and behind
// it: the same plane wave, so the same echo, the same loss and the same direction behind.

#include <gtest/gtest.h>

#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

const Medium kTissue = medium("tissue", 1060, 1584, 0, 1e-3), kFat = medium("fat", 927, 1462),
             kBone = medium("bone", 1862, 3194), kLung = medium("lung", 400, 650),
             kMuscle = medium("muscle", 1065, 1600),
             kDense = medium("dense", 1300, 1584, 0, 1e-3);  // of tissue's speed

// Parallel planes, met by the ray along +z at one angle.
struct FlatStack {
  std::vector<Medium> media;  // before, of each layer, behind: a layer without an end
  std::vector<double> thickness_m;
  double angle_rad = 0;

  Vec3d normal() const { return {std::sin(angle_rad), 0, -std::cos(angle_rad)}; }
  Scene scene() const {
    Scene scene = plainScene(media);
    for (std::size_t m = 1; m < media.size(); ++m) {
      addStructure(scene, m, 1);
      scene.structures.back().reflection_exponent = 0;
    }
    return scene;
  }
  // Crossings of a ray beyond its origin. Surface l is layer l, closed by the plane behind it.
  std::vector<Crossing> crossings(const Ray& ray, double beyond_m) const {
    std::vector<Crossing> met;
    const Vec3d n = normal();
    const double towards = dot(ray.direction, n);
    Vec3d place{0, 0, 0.05};
    for (std::uint32_t l = 0; l + 1 < media.size(); ++l) {
      const double in_m = dot(place - ray.origin, n) / towards;
      if (in_m > beyond_m) met.push_back({in_m, n, SurfaceId{l}, 0, true});
      if (l >= thickness_m.size()) break;
      place = place - thickness_m[l] * n;
      const double out_m = dot(place - ray.origin, n) / towards;
      if (out_m > beyond_m) met.push_back({out_m, -n, SurfaceId{l}, 1, false});
    }
    return met;
  }
};

struct Walk {
  LineTrace trace;
  Vec3d direction;  // at the end
  int rays = 0;

  double back() const {
    double sum = 0;
    for (const Echo& echo : trace.echoes) sum += echo.intensity;
    return sum;
  }
  double behind() const { return trace.segments.back().strength_m2_sr; }
};

Walk walk(const FlatStack& stack, bool bent) {
  const Scene scene = stack.scene();
  TraceSettings settings = straightSettings(scene);
  settings.refraction = bent;
  settings.reflection_cap = false;
  Walk done;
  LineWalker walker(settings, kDepthwards, {}, done.trace);
  while (walker.alive() && done.rays < 20) {
    // A ray that was bent starts on a plane that it has crossed.
    const double beyond_m = done.rays++ == 0 ? 0 : 1e-9;
    walker.advance({stack.crossings(walker.query().ray, beyond_m), walker.query().inside});
  }
  done.direction = walker.query().ray.direction;
  return done;
}

const std::vector<std::vector<Medium>> kStacks{{kTissue, kFat, kTissue},
                                               {kTissue, kBone, kTissue},
                                               {kTissue, kLung, kTissue},
                                               {kTissue, kMuscle, kDense},
                                               {kTissue, kFat, kMuscle, kFat, kTissue},
                                               {kTissue, kBone, kFat, kBone, kDense}};

TEST(BentLayers, EchoLossAndDirectionAreThoseOfStraightRays) {
  for (const std::vector<Medium>& media : kStacks)
    for (const double um : {0.5, 5.0, 40.0, 150.0})
      for (const double degrees : {0.0, 12.0, 28.0, 35.0, 50.0, 65.0}) {
        FlatStack stack{media, {}, radiansFromDegrees(degrees)};
        for (std::size_t l = 1; l + 1 < media.size(); ++l)
          stack.thickness_m.push_back(um * 1e-6 * static_cast<double>(l));
        const Walk bent = walk(stack, true), straight = walk(stack, false);
        const std::string what = media[1].name + ' ' + std::to_string(media.size() - 2) + ' ' +
                                 std::to_string(um) + " um " + std::to_string(degrees);
        ASSERT_GT(straight.back(), 0) << what;
        EXPECT_NEAR(bent.back() / straight.back(), 1, 1e-6) << what;
        EXPECT_NEAR(bent.behind() / straight.behind(), 1, 1e-6) << what;
        EXPECT_NEAR(length(bent.direction - straight.direction), 0, 1e-9) << what;
      }
}

// The bent ray's own way: each layer takes h / cos theta_l, and its faces echo there.
TEST(BentLayers, FacesStandOnTheBentPath) {
  const double h_m = 100e-6, angle_rad = radiansFromDegrees(50);
  const Walk bent = walk({{kTissue, kFat, kTissue}, {h_m}, angle_rad}, true);
  const double sin_fat = std::sin(angle_rad) * kFat.sound_speed_m_s / kTissue.sound_speed_m_s;
  EXPECT_EQ(bent.rays, 3);
  ASSERT_EQ(bent.trace.echoes.size(), 2u);
  EXPECT_NEAR(bent.trace.echoes[1].depth_m - bent.trace.echoes[0].depth_m,
              h_m / std::sqrt(1 - sin_fat * sin_fat), 1e-12);
}

}  // namespace
}  // namespace echocine
