// Neighbours of a body that it nearly follows, and frames that are used again.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "core/hash_random.h"
#include "core/stop.h"
#include "motion/surfaces/interior_motion.h"
#include "support/measured.h"
#include "support/meshes.h"

namespace echocine {
namespace {

constexpr double kOuter_m = 0.035, kInner_m = 0.025;

// A ball that a smooth map moves, by the amount in parts of 2 mm. The surface of its cavity also
// moves by up to 0.15 mm of noise, which no lattice follows.
std::vector<InteriorSurface> ballWithCavity(double amount, double outer_m = kOuter_m) {
  const double phases[] = {0.0, 0.5};
  std::vector<InteriorSurface> surfaces;
  for (const double radius_m : {outer_m, kInner_m}) {
    const support::Mesh ball = support::icosphere(4, radius_m);
    const bool is_cavity = radius_m == kInner_m;
    InteriorSurface surface{
        "ball",   ball.triangles, KeyframeWeights(phases, Interpolation::linear),
        {{}, {}}, false,          is_cavity ? 2 : 1};
    for (std::size_t v = 0; v < ball.points.size(); ++v) {
      const Vec3d p = ball.points[v];
      const auto noise = [&](std::uint64_t axis) {
        return is_cavity ? 0.15e-3 * (2 * uniformFromHash(hashOf(v, axis)) - 1) : 0;
      };
      const Vec3d smooth{2e-3 * std::sin(p.y / 0.01), 2e-3 * std::sin(p.z / 0.01), 0};
      surface.keyframes_m[0].push_back(toFloat(p));
      surface.keyframes_m[1].push_back(
          toFloat(p + amount * (smooth + Vec3d{noise(1), noise(2), noise(3)})));
    }
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

// Where nothing slides and nothing folds the field is linear in the motion, whatever it misses.
TEST(InteriorSlidingLaw, AFieldWithoutSlidingIsLinearInTheMotion) {
  const auto displacementsFor = [](double amount) {
    FieldFrame frame;
    MotionField(ballWithCavity(amount)).at(0.5, frame);
    return frame.groups[0].displacement_m;
  };
  const std::vector<Vec3f> whole = displacementsFor(1), half = displacementsFor(0.5);
  ASSERT_EQ(whole.size(), half.size());
  double most_m = 0, difference_m = 0;
  for (std::size_t n = 0; n < whole.size(); ++n) {
    most_m = std::max(most_m, length(toDouble(whole[n])));
    difference_m = std::max(difference_m, length(toDouble(whole[n]) - 2.0 * toDouble(half[n])));
  }
  support::Largest("difference", "mm")(1e3 * difference_m);
  EXPECT_GT(most_m, 1.5e-3);
  EXPECT_LT(difference_m, 2e-6);
}

// Trabeculae stand out of a wall and move with it, however high they are.
TEST(InteriorSlidingLaw, MaterialBeyondTheSurfacesMovesWithThem) {
  std::vector<InteriorSurface> ball = ballWithCavity(0);
  const Vec3f step_m{3e-3f, -2e-3f, 1e-3f};
  for (InteriorSurface& surface : ball)
    for (Vec3f& p : surface.keyframes_m[1]) p = p + step_m;
  for (const double beyond_m : {0.002, 0.004, 0.008})
    for (const int cells : {24, 64}) {
      FieldFrame frame;
      MotionField(ball, {.cells = cells, .beyond_m = beyond_m}).at(0.5, frame);
      for (std::uint64_t i = 0; i < 500; ++i) {
        const auto in = [&](std::uint64_t n) { return 2 * uniformFromHash(hashOf(i, n)) - 1; };
        const Vec3d p = (kInner_m - beyond_m) * normalised(Vec3d{in(1), in(2), in(3)});
        const Vec3f moved = frame.groups[0].place(toFloat(p)) - toFloat(p);
        ASSERT_LT(length(moved - step_m), 1e-6f) << beyond_m << ' ' << cells;
      }
    }
}

// Also at nodes that no row writes.
TEST(InteriorSlidingLaw, AFrameOfAnotherFieldLeavesNothingBehind) {
  const MotionField other(ballWithCavity(1, 0.045)), field(ballWithCavity(1));
  FieldFrame used, fresh;
  other.at(0.5, used);
  for (GroupFrame& group : used.groups)
    std::fill(group.displacement_m.begin(), group.displacement_m.end(), Vec3f{1, 2, 3});
  field.at(0.3, used);
  field.at(0.3, fresh);
  ASSERT_EQ(used.groups.size(), fresh.groups.size());
  for (std::size_t g = 0; g < fresh.groups.size(); ++g)
    EXPECT_EQ(used.groups[g].displacement_m, fresh.groups[g].displacement_m);
}

// A stop within a frame leaves groups of two fields. The frame is used again afterwards.
TEST(InteriorSlidingLaw, AStoppedFrameIsSetAnew) {
  const MotionField small(ballWithCavity(1)), large(ballWithCavity(1, 0.06));
  FieldFrame used, fresh;
  small.at(0.5, used);
  for (const int checks : {0, 1, 2}) {
    std::atomic<int> left = checks;
    EXPECT_THROW(stoppable([&] { return left-- <= 0; }, [&] { large.at(0.5, used); }), Stopped);
    large.at(0.4, used);
    large.at(0.4, fresh);
    for (std::size_t g = 0; g < fresh.groups.size(); ++g)
      EXPECT_EQ(used.groups[g].displacement_m, fresh.groups[g].displacement_m) << checks;
    small.at(0.5, used);
  }
}

}  // namespace
}  // namespace echocine
