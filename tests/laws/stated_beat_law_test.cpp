// The stated beat of meshes that do not move keeps the muscle's volume.

#include "support/stated_beat.h"

#include <gtest/gtest.h>

namespace echocine::support {
namespace {

constexpr double kInner_m = 22e-3, kOuter_m = 32e-3, kLength_m = 80e-3, kRoof_m = 50e-3;

// A tube around the z axis, from below the apex to above the ring.
TriangleMesh tube(double radius_m) {
  constexpr std::uint32_t kSides = 720;
  TriangleMesh mesh;
  for (const double z : {-20e-3, 140e-3})
    for (std::uint32_t i = 0; i < kSides; ++i) {
      const double angle = 2 * std::numbers::pi * i / kSides;
      mesh.positions.push_back({radius_m * std::cos(angle), radius_m * std::sin(angle), z});
    }
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const std::uint32_t j = (i + 1) % kSides;
    mesh.triangles.push_back({i, j, kSides + j});
    mesh.triangles.push_back({i, kSides + j, kSides + i});
  }
  return mesh;
}

// Factor of a small volume at a point, by differences.
double growth(const StatedBeat& beat, Vec3d p, double s) {
  constexpr double kStep_m = 1e-6;
  const auto slope = [&](Vec3d way) {
    return 0.5 / kStep_m *
           (beat.moved(p + kStep_m * way, s, kRoof_m) - beat.moved(p - kStep_m * way, s, kRoof_m));
  };
  return dot(slope({1, 0, 0}), cross(slope({0, 1, 0}), slope({0, 0, 1})));
}

TEST(StatedBeat, EmptiesCavitiesAndKeepsTheMuscle) {
  const BeatStated stated{.ef = 0.6, .rv_ef = 0.45, .shortening = 0.15, .twist_deg = 12};
  const StatedBeat beat({{0, 0, 0}, {0, 0, kLength_m}, tube(kInner_m), {tube(kOuter_m)}}, stated);
  for (const double s : {0.0, 0.4, 1.0})
    for (const double z : {0.1, 0.45, 0.78})
      for (const double angle : {0.3, 2.0, 4.5}) {
        const auto at = [&](double r) {
          return growth(beat, {r * std::cos(angle), r * std::sin(angle), z * kLength_m}, s);
        };
        EXPECT_NEAR(at(10e-3), 1 - stated.ef * s, 1e-3);
        EXPECT_NEAR(at(27e-3), 1, 1e-3);
        EXPECT_NEAR(at(45e-3), 1 - stated.rv_ef * s, 1e-3);
      }
}

TEST(StatedBeat, ApexAndRoofStayAndTheRingDescends) {
  const StatedBeat beat({{0, 0, 0}, {0, 0, kLength_m}, tube(kInner_m), {tube(kOuter_m)}},
                        {.shortening = 0.15});
  EXPECT_NEAR(length(beat.moved({0, 0, 0}, 1, kRoof_m)), 0, 1e-12);
  EXPECT_NEAR(beat.moved({0, 0, kLength_m}, 1, kRoof_m).z, 0.85 * kLength_m, 1e-12);
  const Vec3d roof{5e-3, -8e-3, kLength_m + kRoof_m};
  EXPECT_NEAR(length(beat.moved(roof, 1, kRoof_m) - roof), 0, 1e-12);
  for (const Vec3d p : {Vec3d{3e-3, 4e-3, 0.03}, Vec3d{30e-3, 0, 0.1}})
    EXPECT_NEAR(length(beat.moved(p, 0, kRoof_m) - p), 0, 1e-12);
}

}  // namespace
}  // namespace echocine::support
