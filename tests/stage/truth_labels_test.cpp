// Labels of pixels and of samples are those of a brute-force test of every place by itself.

#include <gtest/gtest.h>

#include <cmath>

#include "core/hash_random.h"
#include "scene/scan_geometry.h"
#include "support/meshes.h"
#include "support/plain_scene.h"
#include "truth/plane_labels.h"
#include "truth/sector_clip.h"

namespace echocine {
namespace {

struct Ball {
  Vec3d middle;
  double radius;
  int priority;
};

// Balls that overlap, the strongest in the middle of the list.
const Ball kBalls[] = {{{-0.01, 0.002, 0.07}, 0.03, 1},
                       {{0.01, -0.003, 0.08}, 0.025, 5},
                       {{0.0, 0.004, 0.1}, 0.03, 3},
                       {{0.05, 0.0, 0.1}, 0.03, 3}};

struct World {
  Scene scene = support::plainScene({support::medium("water", 1000, 1500)});
  std::vector<SurfaceTopology> surfaces;
  SurfaceFrame frame;
  std::vector<support::Mesh> meshes;

  World() {
    scene.probe.lines = 64;
    scene.probe.samples = 200;
    for (const Ball& ball : kBalls) {
      support::addStructure(scene, 0, ball.priority);
      meshes.push_back(support::icosphere(2, ball.radius).moved(ball.middle));
      const support::Mesh& mesh = meshes.back();
      surfaces.push_back({static_cast<SurfaceId>(surfaces.size()), mesh.triangles,
                          static_cast<std::uint32_t>(mesh.points.size())});
      auto& positions = frame.positions_m.emplace_back();
      for (const Vec3d p : mesh.points) positions.push_back(toFloat(p));
    }
  }

  // The strongest ball whose solid angle seen from the place is the whole sphere; among equals the
  // later. Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 125-126, 1983.
  std::uint32_t at(Vec3d place) const {
    std::uint32_t best = 0;
    for (std::uint32_t s = 0; s < meshes.size(); ++s) {
      double angle = 0;
      for (const Triangle& t : meshes[s].triangles) {
        const Vec3d a = toDouble(frame.positions_m[s][t[0]]) - place,
                    b = toDouble(frame.positions_m[s][t[1]]) - place,
                    c = toDouble(frame.positions_m[s][t[2]]) - place;
        const double la = length(a), lb = length(b), lc = length(c);
        angle += 2 * std::atan2(dot(a, cross(b, c)),
                                la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
      }
      if (angle > 6 && (best == 0 || kBalls[s].priority >= kBalls[best - 1].priority)) best = s + 1;
    }
    return best;
  }
};

const PictureGrid kSquareGrid{160, 160, 80.3, 5.1, 1.05e-3};

TEST(TruthLabels, PixelsAreThoseOfABruteForceTest) {
  const World world;
  PlaneSlice slice(world.surfaces, world.scene.probe);
  slice.update(world.frame);
  PlaneLabels::Ids ids;
  PlaneLabels(world.scene, kSquareGrid).picture(slice.edges(), ids);
  int inside = 0;
  for (int row = 0; row < kSquareGrid.height; ++row)
    for (int column = 0; column < kSquareGrid.width; ++column) {
      const Vec3d place{kSquareGrid.xOf(column), 0, kSquareGrid.zOf(row)};
      const bool shown = inScanArea(world.scene.probe, place.x, place.z);
      const std::uint32_t id = ids[static_cast<std::size_t>(row * kSquareGrid.width + column)];
      ASSERT_EQ(id, shown ? world.at(place) : 0) << "pixel " << column << ", " << row;
      inside += id > 0;
    }
  EXPECT_GT(inside, 2000);
}

TEST(TruthLabels, SamplesAreThoseOfABruteForceTest) {
  const World world;
  PlaneSlice slice(world.surfaces, world.scene.probe);
  slice.update(world.frame);
  std::vector<std::uint32_t> ids;
  PlaneLabels(world.scene, kSquareGrid).samples(slice.lines(), ids);
  const Probe& probe = world.scene.probe;
  for (int i = 0; i < probe.lines; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    for (int k = 0; k < probe.samples; ++k) {
      const double path_m = probe.min_depth_m + (k + 0.5) * probe.sampleSpacing();
      ASSERT_EQ(ids[static_cast<std::size_t>(i * probe.samples + k)],
                world.at(line.origin + path_m * line.direction))
          << "line " << i << ", sample " << k;
    }
  }
}

TEST(TruthLabels, TheSectorClosesAContourThatItCuts) {
  Probe probe = support::plainScene({support::medium("water", 1000, 1500)}).probe;
  const std::vector<Vec3d> outline = sectorOutline(probe);
  // A square half outside to the right: what is left is bounded by the last line.
  const double z = 0.08, edge = z * std::tan(probe.last_angle_rad);
  const std::vector<Vec3d> kept = clipped({{edge - 0.01, 0, z - 0.001},
                                           {edge + 0.02, 0, z - 0.001},
                                           {edge + 0.02, 0, z + 0.001},
                                           {edge - 0.01, 0, z + 0.001}},
                                          outline);
  ASSERT_GE(kept.size(), 4u);
  for (const Vec3d p : kept) EXPECT_LE(std::atan2(p.x, p.z), probe.last_angle_rad + 1e-9);
  // Inside it is left as it is, outside nothing is left.
  const std::vector<Vec3d> small{{0, 0, 0.05}, {0.01, 0, 0.05}, {0, 0, 0.06}};
  EXPECT_EQ(clipped(small, outline).size(), 3u);
  EXPECT_TRUE(clipped({{0, 0, -0.05}, {0.01, 0, -0.05}, {0, 0, -0.06}}, outline).empty());
}

}  // namespace
}  // namespace echocine
