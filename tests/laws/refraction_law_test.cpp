// Snell's law in space.

#include <gtest/gtest.h>

#include "support/surfaces.h"
#include "trace/interface_law.h"

namespace echocine {
namespace {

using support::RandomVectors;

constexpr int kRays = 20000;
constexpr std::pair<double, double> kSpeeds[] = {
    {1480, 1600}, {1600, 1480}, {1580, 1584}, {650, 1580}, {1580, 3194}};

double sine(Vec3d direction, Vec3d normal) {
  return length(cross(direction, normal));
}

// Calls check(direction, normal, bent) for random rays that pass.
template <typename Check>
int forPassingRays(double c_1, double c_2, Check&& check) {
  RandomVectors random(7);
  int passed = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vec3d direction = random.direction(), normal = random.direction();
    if (const auto bent = refracted(direction, normal, c_1, c_2)) {
      ++passed;
      check(direction, normal, *bent);
    }
  }
  return passed;
}

// Snell: sin(theta_t) / c_2 = sin(theta_i) / c_1.
TEST(Refraction, SinesAreInTheRatioOfTheSpeeds) {
  for (const auto& [c_1, c_2] : kSpeeds)
    forPassingRays(c_1, c_2, [&, c1 = c_1, c2 = c_2](Vec3d d, Vec3d n, Vec3d bent) {
      EXPECT_NEAR(sine(bent, n) * c1, sine(d, n) * c2, 1e-12 * c2);
    });
}

TEST(Refraction, DirectionStaysUnitInThePlaneOfIncidenceAndOnItsSide) {
  for (const auto& [c_1, c_2] : kSpeeds)
    forPassingRays(c_1, c_2, [](Vec3d d, Vec3d n, Vec3d bent) {
      EXPECT_NEAR(length(bent), 1, 1e-15);
      EXPECT_NEAR(dot(bent, cross(d, n)), 0, 1e-15);
      EXPECT_GE(dot(bent, n) * dot(d, n), 0);
      EXPECT_GE(dot(cross(bent, n), cross(d, n)), 0);
    });
}

// Else straight rays would drift with every interface.
TEST(Refraction, EqualSpeedsLeaveTheDirectionUnchangedToTheLastBit) {
  const int passed =
      forPassingRays(1540, 1540, [](Vec3d d, Vec3d, Vec3d bent) { EXPECT_EQ(d, bent); });
  EXPECT_EQ(passed, kRays);
  EXPECT_EQ(refracted({1, 0, 0}, {0, 0, 1}, 1540, 1540), (Vec3d{1, 0, 0}));
}

// Reciprocity: echoes come back the way they went.
TEST(Refraction, TheWayBackIsTheWayThere) {
  for (const auto& [c_1, c_2] : kSpeeds)
    forPassingRays(c_1, c_2, [&, c1 = c_1, c2 = c_2](Vec3d d, Vec3d n, Vec3d bent) {
      const auto back = refracted(-bent, n, c2, c1);
      // At the critical angle the way back leaves along the surface: the sine is lost in rounding.
      if (std::abs(dot(bent, n)) < 1e-5 || std::abs(dot(d, n)) < 1e-5) return;
      ASSERT_TRUE(back);
      EXPECT_LT(length(*back + d), 1e-10);
    });
}

// A facet has two sides, and which is outward is the mesh's say.
TEST(Refraction, TheSideOfTheNormalDoesNotMatter) {
  forPassingRays(1480, 1600, [](Vec3d d, Vec3d n, Vec3d bent) {
    EXPECT_EQ(refracted(d, -n, 1480, 1600), bent);
  });
}

// sin(theta_t) would exceed 1: total reflection.
TEST(Refraction, NothingPassesBeyondTheCriticalAngle) {
  const double critical = std::asin(1480.0 / 1600.0);
  for (const double turn : {-1e-9, 1e-9, 1e-3}) {
    const double angle = critical + turn;
    const Vec3d d{std::sin(angle), 0, std::cos(angle)};
    EXPECT_EQ(refracted(d, {0, 0, -1}, 1480, 1600).has_value(), turn < 0);
  }
}

TEST(Refraction, NormalIncidenceGoesStraightOn) {
  RandomVectors random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d d = random.direction();
    const auto bent = refracted(d, d, 1480, 3194);
    ASSERT_TRUE(bent);
    EXPECT_LT(length(*bent - d),
              3e-8);  // cos_i rounds, so the angle is known to its square root only
  }
}

}  // namespace
}  // namespace echocine
