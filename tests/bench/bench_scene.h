#pragma once
// Hearts of spheres with a stated number of triangles, moving from frame to frame.

#include <cmath>
#include <vector>

#include "support/meshes.h"
#include "support/plain_scene.h"

namespace echocine::bench {

// Wall, cavity and two atria: four closed surfaces, all in the sector, a few millimetres off the
// imaging plane.
struct BenchScene {
  Scene scene;
  std::vector<SurfaceTopology> topology;
  std::vector<SurfaceFrame> frames;  // a beat in eight steps

  explicit BenchScene(int triangles) {
    scene = support::plainScene({support::medium("tissue", 1050, 1584, 14, 1e-3),
                                 support::medium("blood", 1060, 1584, 4, 3e-6),
                                 support::medium("wall", 1097, 1584, 15, 1.6e-3)});
    scene.probe.min_depth_m = 0.002;
    scene.probe.lines = 256;
    scene.probe.samples = 1024;
    scene.output.channels = {Channel::y};
    scene.output.cine = false;
    support::addStructure(scene, 2, 1);
    for (int i = 0; i < 3; ++i) support::addStructure(scene, 1, 2);
    const struct {
      double radius;
      Vec3d middle;
    } balls[] = {{0.035, {0.002, 0.0031, 0.07}},
                 {0.025, {0.002, 0.0031, 0.07}},
                 {0.02, {0.021, 0.0013, 0.13}},
                 {0.02, {-0.021, 0.0017, 0.13}}};
    const int segments = 2 * static_cast<int>(std::lround(std::sqrt(triangles / 4.0 / 4.0)));
    frames.resize(8);
    for (const auto& ball : balls) addBall(ball.radius, ball.middle, segments);
  }

 private:
  void addBall(double radius, Vec3d middle, int segments) {
    const support::Mesh mesh = support::uvSphere(segments / 2 + 1, segments, 1);
    topology.push_back({SurfaceId{static_cast<std::uint32_t>(topology.size())}, mesh.triangles,
                        static_cast<std::uint32_t>(mesh.points.size()), false, false});
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const double beat = 1 + 0.1 * std::cos(2 * std::numbers::pi * static_cast<double>(f) / 8);
      frames[f].positions_m.emplace_back();
      for (const Vec3d& p : mesh.points)
        frames[f].positions_m.back().push_back(toFloat(middle + radius * beat * p));
    }
  }
};

}  // namespace echocine::bench
