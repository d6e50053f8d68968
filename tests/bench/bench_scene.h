#pragma once
// Hearts of spheres with a stated number of triangles, moving from frame to frame.

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "motion/keyframes/control_motion.h"
#include "motion/surfaces/near_plane.h"
#include "support/meshes.h"
#include "support/plain_scene.h"

namespace echocine::bench {

inline constexpr int kKeyframes = 8;

// Arguments of a benchmark: state.range(0), (1) and (2).
struct Size {
  int triangles = 50000, lines = 256, samples = 1024;

  Size() = default;
  explicit Size(const benchmark::State& state)
      : triangles(static_cast<int>(state.range(0))),
        lines(static_cast<int>(state.range(1))),
        samples(static_cast<int>(state.range(2))) {}
};

// Four chambers with their walls in a pericardium: nine closed surfaces, all in the sector, their
// middles a few millimetres off the imaging plane. Eight keyframes a beat; frames fall between
// them, so that every one is blended.
struct BenchScene {
  Scene scene;
  std::vector<SurfaceTopology> topology;
  std::vector<std::vector<std::vector<Vec3f>>> keyframes_m;  // by surface, then keyframe
  std::vector<ControlMotion> motion;                         // by surface
  std::vector<SurfaceFrame> frames;                          // of the phases below
  static double phase(std::size_t i) { return (static_cast<double>(i % 8) + 0.4) / 8; }

  explicit BenchScene(const Size& size) {
    scene = support::plainScene({support::medium("tissue", 1050, 1584, 14, 1e-3),
                                 support::medium("blood", 1060, 1584, 4, 3e-6),
                                 support::medium("wall", 1097, 1584, 15, 1.6e-3)});
    scene.probe.min_depth_m = 0.002;
    scene.probe.lines = size.lines;
    scene.probe.samples = size.samples;
    scene.output.channels = {Channel::y};
    const struct {
      double radius;
      Vec3d middle;
      std::size_t medium;
      int priority;
    } balls[] = {{0.068, {0.001, 0.0017, 0.086}, 1, 1},  // pericardium, with fluid
                 {0.036, {0.022, 0.0031, 0.062}, 2, 2},  // ventricles and atria: wall, cavity
                 {0.026, {0.022, 0.0031, 0.062}, 1, 3},  {0.027, {-0.028, 0.0023, 0.066}, 2, 2},
                 {0.023, {-0.028, 0.0023, 0.066}, 1, 3}, {0.025, {0.022, 0.0013, 0.122}, 2, 2},
                 {0.022, {0.022, 0.0013, 0.122}, 1, 3},  {0.024, {-0.027, 0.0019, 0.118}, 2, 2},
                 {0.021, {-0.027, 0.0019, 0.118}, 1, 3}};
    const auto each = static_cast<double>(size.triangles) / std::size(balls);
    const int segments = 2 * static_cast<int>(std::lround(std::sqrt(each / 4)));
    for (const auto& ball : balls) {
      support::addStructure(scene, ball.medium, ball.priority);
      addBall(ball.radius, ball.middle, segments);
    }
    frames.resize(8);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      frames[f].positions_m.resize(motion.size());
      for (std::size_t s = 0; s < motion.size(); ++s)
        motion[s].at(phase(f), frames[f].positions_m[s]);
    }
  }

  const SurfaceFrame& frame(std::size_t i) const { return frames[i % frames.size()]; }

 private:
  void addBall(double radius, Vec3d middle, int segments) {
    const support::Mesh mesh = support::uvSphere(segments / 2 + 1, segments, 1);
    topology.push_back({SurfaceId{static_cast<std::uint32_t>(topology.size())}, mesh.triangles,
                        static_cast<std::uint32_t>(mesh.points.size()), false, false});
    std::vector<std::vector<Vec3f>> rows;
    std::vector<double> phases;
    HeightRanges heights;
    for (int k = 0; k < kKeyframes; ++k) {
      const double beat = 1 + 0.1 * std::cos(2 * std::numbers::pi * k / kKeyframes);
      rows.emplace_back();
      for (const Vec3d& p : mesh.points) rows.back().push_back(toFloat(middle + radius * beat * p));
      phases.push_back(static_cast<double>(k) / kKeyframes);
      heights.add(rows.back());
    }
    keyframes_m.push_back(rows);
    motion.push_back({KeyframeWeights(phases, scene.motion.interpolation),
                      mesh.triangles,
                      std::move(rows),
                      {},
                      false});
    topology.back().near_plane =
        heights.nearPlane(mesh.triangles, motion.back().weights.overshoot());
  }
};

}  // namespace echocine::bench
