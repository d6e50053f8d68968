// The field inside a body whose surface moves by a closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/hash_random.h"
#include "core/parallel.h"
#include "motion/interior/lattice_equations.h"
#include "motion/surfaces/interior_motion.h"
#include "scene/scene_reader.h"
#include "support/measured.h"
#include "support/meshes.h"
#include "support/paths.h"

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
  support::Largest("miss", "mm")(1e3 * miss_m);
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

// Pure bending about y by a curvature of 1 / (30 cm) with Poisson's ratio 0.5, small strains.
TEST(InteriorMotionLaw, ABarThatBendsDoesSoInside) {
  EXPECT_LT(missOf([](Vec3d p) {
              constexpr double kCurvature = 1 / 0.3, kPoisson = 0.5;
              return p + kCurvature * Vec3d{-0.5 * (p.z * p.z + kPoisson * (p.x * p.x - p.y * p.y)),
                                            -kPoisson * p.x * p.y, p.x * p.z};
            }),
            kNear_m);
}

// The largest miss inside the wall of a ball with a cavity that keeps its volume, m:
// r'^3 = r^3 + c. 25 mm and 35 mm outside, 2 mm more inside.
double missOfBall(int cells) {
  constexpr double kInner_m = 0.025, kOuter_m = 0.035;
  const auto map = [](Vec3d p) {
    constexpr double kGrowth = 0.027 * 0.027 * 0.027 - kInner_m * kInner_m * kInner_m;
    const double r = length(p);
    return std::cbrt(1 + kGrowth / (r * r * r)) * p;
  };
  const double phases[] = {0.0, 0.5};
  std::vector<InteriorSurface> surfaces;
  for (const double radius_m : {kOuter_m, kInner_m}) {
    const support::Mesh ball = support::icosphere(4, radius_m);
    InteriorSurface surface{
        "ball",   ball.triangles, KeyframeWeights(phases, Interpolation::linear),
        {{}, {}}, false,          radius_m < 0.03 ? 2 : 1};
    for (const Vec3d p : ball.points) {
      surface.keyframes_m[0].push_back(toFloat(kMiddle_m + p));
      surface.keyframes_m[1].push_back(toFloat(kMiddle_m + map(p)));
    }
    surfaces.push_back(std::move(surface));
  }
  const MotionField field(std::move(surfaces), {.cells = cells});
  FieldFrame frame;
  field.at(0.5, frame);
  double miss_m = 0;
  for (std::uint64_t i = 0; i < 8000; ++i) {
    const auto in = [&](std::uint64_t n) {
      return kOuter_m * (2 * uniformFromHash(hashOf(i, n)) - 1);
    };
    const Vec3d p{in(1), in(2), in(3)};
    if (length(p) < kInner_m || length(p) > kOuter_m) continue;
    const Vec3d placed = toDouble(frame.groups[0].place(toFloat(kMiddle_m + p)));
    miss_m = std::max(miss_m, length(placed - kMiddle_m - map(p)));
  }
  support::Largest("miss", "mm")(1e3 * miss_m);
  return miss_m;
}

TEST(InteriorMotionLaw, ABallThatInflatesDoesSoInsideItsWall) {
  EXPECT_LT(missOfBall(FieldSettings{}.cells), kNear_m);
}

// Trilinear interpolation misses by the square of the spacing, the borders of walls by less.
TEST(InteriorMotionLaw, TheErrorGrowsWithTheSpacing) {
  double finer_m = missOfBall(48);
  for (const int cells : {32, 24, 16}) {
    const double miss_m = missOfBall(cells), spacings = 48.0 / cells;
    EXPECT_GT(miss_m, finer_m) << cells;
    EXPECT_LT(miss_m, 0.016e-3 * spacings * spacings) << cells;
    finer_m = miss_m;
  }
}

constexpr double kConverged = 1e-6;

TEST(InteriorMotionLaw, TheSolveConverges) {
  const MotionField field({movingBlock([](Vec3d p) { return (1 + 9 * p.z * p.x / 0.03) * p; })});
  EXPECT_GT(field.residual(), 0);
  EXPECT_LE(field.residual(), kConverged);
}

TEST(InteriorMotionLaw, TheSolveOfTheShippedHeartConverges) {
  const Scene scene =
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
  const MeshMotion motion(scene);
  const MotionField field = interiorMotion(scene, motion);
  EXPECT_GT(field.residual(), 0);
  EXPECT_LE(field.residual(), kConverged);
}

// The residual that the solver names, against one of its own: the sum that is minimised has no
// slope. A lattice of 9 x 9 x 9 nodes with samples on a sphere.
TEST(InteriorMotionLaw, TheSolutionMinimisesItsSum) {
  constexpr int kNodes = 9;
  ActiveNodes nodes{kNodes, kNodes, kNodes, {}, {}};
  for (std::uint32_t n = 0; n < kNodes * kNodes * kNodes; ++n) {
    nodes.number.push_back(static_cast<std::int32_t>(n));
    nodes.nodes.push_back(n);
  }
  std::vector<LatticeSample> samples;
  std::vector<float> data;
  for (std::uint64_t i = 0; i < 600; ++i) {
    const double z = 2 * uniformFromHash(hashOf(i, 1)) - 1,
                 turn = 6.2832 * uniformFromHash(hashOf(i, 2));
    const double across = std::sqrt(1 - z * z);
    const double at[3] = {4 + 3 * across * std::cos(turn), 4 + 3 * across * std::sin(turn),
                          4 + 3 * z};
    LatticeSample sample{};
    for (int c = 0; c < 8; ++c) {
      const int up[3] = {c & 1, c >> 2, c >> 1 & 1};
      double share = 1;
      int node[3];
      for (std::size_t a = 0; a < 3; ++a) {
        const double fraction = at[a] - std::floor(at[a]);
        share *= up[a] != 0 ? fraction : 1 - fraction;
        node[a] = static_cast<int>(at[a]) + up[a];
      }
      sample.node[c] = static_cast<std::uint32_t>(nodes.at(node[0], node[1], node[2]));
      sample.share[c] = static_cast<float>(share);
    }
    samples.push_back(sample);
    data.push_back(static_cast<float>(std::sin(at[0]) * at[1]));
  }
  const std::vector<float> stiffness(nodes.nodes.size(), 1.0f);
  const std::vector<bool> own(nodes.nodes.size(), true);
  const LatticeFit fit(nodes, samples, stiffness, own, {});
  const LatticeFit::Solution found = fit.solve(data, 1, {}, kConverged);
  EXPECT_LE(found.residual, kConverged);
  const LatticeEquations equations(nodes, samples, stiffness, own, {});
  std::vector<double> right(nodes.nodes.size(), 0.0);
  for (std::size_t j = 0; j < samples.size(); ++j)
    for (std::size_t c = 0; c < 8; ++c)
      right[samples[j].node[c]] +=
          static_cast<double>(samples[j].share[c]) * static_cast<double>(data[j]);
  double left2 = 0, right2 = 0;
  for (std::size_t n = 0; n < right.size(); ++n) {
    const auto row = equations.rows()[n];
    double left = right[n];
    for (std::size_t m = 0; m < row.members.size(); ++m)
      left -= row.values[m] * static_cast<double>(found.values[row.members[m]]);
    left2 += left * left;
    right2 += right[n] * right[n];
  }
  // The solution is rounded to floats, which adds a few of their last digits.
  EXPECT_LT(std::sqrt(left2 / right2), 2 * kConverged);
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

// Rows of a spline's second derivatives, dozens of times the motion, are no displacements.
TEST(InteriorMotionLaw, TheReachAcrossThePlaneHoldsTheBeatAndLittleMore) {
  const double phases[] = {0.0, 0.3, 0.5, 0.8};
  for (const Interpolation kind : {Interpolation::linear, Interpolation::spline}) {
    InteriorSurface block = movingBlock([](Vec3d p) { return p + Vec3d{0, 0.004, 0}; });
    const std::vector<Vec3f> at_rest = block.keyframes_m[0], moved = block.keyframes_m[1];
    block.weights = KeyframeWeights(phases, kind);
    block.keyframes_m = {at_rest, moved, moved, at_rest};
    const MotionField field({block});
    double most_m = 0;
    FieldFrame frame;
    constexpr int kPhases = 200;
    for (int i = 0; i < kPhases; ++i) {
      field.at(static_cast<double>(i) / kPhases, frame);
      for (const GroupFrame& group : frame.groups)
        for (const Vec3f d : group.displacement_m)
          most_m = std::max(most_m, std::abs(static_cast<double>(d.y)));
    }
    EXPECT_GT(most_m, 3.9e-3);
    EXPECT_GE(field.reachAcrossPlane(), most_m);
    EXPECT_LE(field.reachAcrossPlane(), 2 * most_m);
  }
}

}  // namespace
}  // namespace echocine
