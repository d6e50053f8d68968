// The field inside a body whose surface moves by a closed form.

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "motion/interior/motion_field.h"

namespace echocine {
namespace {

constexpr double kHalf_m = 0.03;
const Vec3d kMiddle_m{0, 0, 0.08};

using Map = Vec3d (*)(Vec3d);  // of a place from the middle, m

// A cube of 6 cm with an edge of mesh of 2.5 mm, which moves by one map half-way through the beat.
InteriorSurface movingBlock(Map map) {
  constexpr int kCells = 24;
  const double phases[] = {0.0, 0.5};
  InteriorSurface block{"block",  {},    KeyframeWeights(phases, Interpolation::linear),
                        {{}, {}}, false, 1};
  for (int side = 0; side < 6; ++side) {
    const auto first = static_cast<std::uint32_t>(block.keyframes_m[0].size());
    for (int i = 0; i <= kCells; ++i)
      for (int j = 0; j <= kCells; ++j) {
        double at[3];
        const auto axis = static_cast<std::size_t>(side / 2);
        at[axis] = side % 2 == 0 ? -kHalf_m : kHalf_m;
        at[(axis + 1) % 3] = kHalf_m * (2.0 * i / kCells - 1);
        at[(axis + 2) % 3] = kHalf_m * (2.0 * j / kCells - 1);
        const Vec3d p{at[0], at[1], at[2]};
        block.keyframes_m[0].push_back(toFloat(kMiddle_m + p));
        block.keyframes_m[1].push_back(toFloat(kMiddle_m + map(p)));
      }
    constexpr std::uint32_t kRow = kCells + 1;
    for (std::uint32_t i = 0; i < kCells; ++i)
      for (std::uint32_t j = 0; j < kCells; ++j) {
        const std::uint32_t a = first + i * kRow + j, b = a + kRow, c = b + 1, d = a + 1;
        const auto add = [&](std::uint32_t u, std::uint32_t v, std::uint32_t w) {
          block.triangles.push_back(side % 2 == 0 ? Triangle{u, w, v} : Triangle{u, v, w});
        };
        add(a, b, c);
        add(a, c, d);
      }
  }
  return block;
}

FieldFrame frameOf(Map map) {
  const MotionField field({movingBlock(map)});
  FieldFrame frame;
  field.at(0.5, frame);
  return frame;
}

// The most that any place of the block is off, m; at and between the lattice's nodes.
double missOf(Map map) {
  const FieldFrame frame = frameOf(map);
  double miss_m = 0;
  constexpr int kPlaces = 14;
  for (int i = -kPlaces; i <= kPlaces; ++i)
    for (int j = -kPlaces; j <= kPlaces; ++j)
      for (int k = -kPlaces; k <= kPlaces; ++k) {
        const Vec3d p =
            kHalf_m / kPlaces *
            Vec3d{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
        const Vec3f placed = frame.groups[0].place(toFloat(kMiddle_m + p));
        miss_m = std::max(miss_m, length(toDouble(placed) - kMiddle_m - map(p)));
      }
  ::testing::Test::RecordProperty("miss_um", static_cast<int>(1e6 * miss_m));
  return miss_m;
}

constexpr double kNear_m = 0.05e-3;

// 3 degrees a centimetre, 9 at the ends. Bilinear, so no field is smoother.
TEST(InteriorMotionLaw, ABlockThatTwistsDoesSoInside) {
  EXPECT_LT(missOf([](Vec3d p) {
              constexpr double kTwist = 0.0524e2;  // rad/m
              return p + kTwist * p.z * Vec3d{-p.y, p.x, 0};
            }),
            kNear_m);
}

TEST(InteriorMotionLaw, ABlockThatShearsDoesSoInside) {
  EXPECT_LT(missOf([](Vec3d p) { return p + Vec3d{0.2 * p.z, 0, 0.1 * p.y}; }), kNear_m);
}

TEST(InteriorMotionLaw, ABlockThatDilatesDoesSoInside) {
  EXPECT_LT(missOf([](Vec3d p) { return 1.15 * p; }), kNear_m);
}

// Pure bending about y by a curvature of 1 / (30 cm), with Poisson's ratio 0.5. The smoothest field
// is flatter: the fit's stiffness takes 0.16 mm from the corners.
TEST(InteriorMotionLaw, ABarThatBendsDoesSoInside) {
  EXPECT_LT(missOf([](Vec3d p) {
              constexpr double kCurvature = 1 / 0.3, kPoisson = 0.5;
              return p + kCurvature * Vec3d{-0.5 * (p.z * p.z + kPoisson * (p.x * p.x - p.y * p.y)),
                                            -kPoisson * p.x * p.y, p.x * p.z};
            }),
            0.2e-3);
}

TEST(InteriorMotionLaw, TheFieldIsTheSameForAnyNumberOfThreads) {
  const auto fieldOn = [](int threads) {
    FieldFrame frame;
    withThreads(threads, [&] {
      frame = frameOf([](Vec3d p) { return p + 5.0 * p.z * Vec3d{-p.y, p.x, 0}; });
    });
    return frame;
  };
  const FieldFrame one = fieldOn(1), four = fieldOn(4);
  for (std::size_t g = 0; g < one.groups.size(); ++g) {
    const auto &a = one.groups[g].displacement_m, &b = four.groups[g].displacement_m;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) EXPECT_EQ(a[n], b[n]);
  }
}

}  // namespace
}  // namespace echocine
