// The triangles that the imaging plane can reach: a slice that looks at no others misses nothing.

#include <gtest/gtest.h>

#include "geometry/plane_slice.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

// A ball of 1 cm that stands at these heights over the imaging plane, in cm, and breathes.
Scene risingBall(const TestFolder& folder, const std::vector<double>& heights_cm,
                 Interpolation kind) {
  std::vector<TriangleMesh> keyframes;
  for (std::size_t k = 0; k < heights_cm.size(); ++k) {
    keyframes.push_back(sphere(1 + 0.02 * static_cast<double>(k), 2));
    for (Vec3d& p : keyframes.back().positions) p = p + Vec3d{0.3, heights_cm[k], 5};
  }
  return sceneWith(folder, keyframes, kind);
}

// Slices of all triangles and of those near the plane, at many phases. Returns the number of
// edges, and the share of the triangles that is near.
std::pair<std::size_t, double> compareSlices(const Scene& scene) {
  const MeshMotion motion(scene);
  std::vector<SurfaceTopology> any = motion.surfaces();
  any[0].near_plane.reset();
  PlaneSlice of_near(motion.surfaces(), scene.probe), of_any(any, scene.probe);
  SurfaceFrame frame;
  std::size_t edges = 0;
  for (int i = 0; i < 128; ++i) {
    motion.frameAt(i / 128.0, frame);
    of_near.update(frame);
    of_any.update(frame);
    EXPECT_EQ(of_near.edges().size(), of_any.edges().size()) << "phase " << i / 128.0;
    if (of_near.edges().size() != of_any.edges().size()) break;
    for (std::size_t p = 0; p < of_any.edges().size(); ++p) {
      EXPECT_EQ(of_near.edges()[p].triangle, of_any.edges()[p].triangle);
      EXPECT_TRUE(of_near.edges()[p].cut.from == of_any.edges()[p].cut.from);
    }
    edges += of_any.edges().size();
  }
  return {edges, static_cast<double>(motion.surfaces()[0].near_plane->size()) /
                     static_cast<double>(any[0].triangles.size())};
}

TEST(NearPlane, NoCutTriangleIsMissedAtAnyPhase) {
  const TestFolder folder;
  for (const Interpolation kind : kInterpolations)
    for (const int subdivision : {0, 1}) {
      Scene scene = risingBall(folder, {0.2, 0.5, 0.35, -0.1}, kind);
      scene.motion.subdivision = subdivision;
      const auto [edges, share] = compareSlices(scene);
      EXPECT_GT(edges, 128U * 20);
      EXPECT_LT(share, 0.75);
    }
}

// Between keyframes that all stand clear of the plane a smooth interpolation dips into it.
TEST(NearPlane, OvershootIsCounted) {
  const TestFolder folder;
  for (const Interpolation kind : kInterpolations) {
    const std::size_t edges = compareSlices(risingBall(folder, {3, 1.08, 1.09, 3.1}, kind)).first;
    const bool straight = kind == Interpolation::linear || kind == Interpolation::cycle;
    EXPECT_EQ(edges > 0, !straight) << static_cast<int>(kind);
  }
}

TEST(NearPlane, SurfaceClearOfThePlaneHasNone) {
  const TestFolder folder;
  for (const Interpolation kind : kInterpolations) {
    const MeshMotion motion(risingBall(folder, {5, 5.5, 6}, kind));
    EXPECT_TRUE(motion.surfaces()[0].near_plane->empty());
  }
}

}  // namespace
}  // namespace echocine::motion_test
