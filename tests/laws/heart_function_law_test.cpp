// Truth of hearts whose motion is known in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "motion/surfaces/interior_motion.h"
#include "scene/scan_geometry.h"
#include "support/scene_text.h"
#include "truth/frame_truth.h"

namespace echocine {
namespace {

using support::Mesh;
using Map = std::function<Vec3d(Vec3d)>;

// A left ventricle in its wall, mm in the probe frame, at rest and half-way through the beat.
struct TwoPhases {
  Mesh cavity, wall;
  Map map;  // of every place, mm
};

Mesh mapped(Mesh mesh, const Map& map) {
  for (Vec3d& p : mesh.points) p = map(p);
  return mesh;
}

std::shared_ptr<const TriangleMesh> shared(const Mesh& mesh) {
  return std::make_shared<TriangleMesh>(TriangleMesh{mesh.points, mesh.triangles, {}, {}});
}

Scene sceneOf(const TwoPhases& heart) {
  support::SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}, {"interpolation", "\"linear\""}};
  text.probe["depth_mm"] = "160";
  text.probe["lines"] = "32";
  text.addStructure("wall", "myocardium", "[\"wall_0\", \"wall_1\"]", 1, "role = \"lv_wall\"");
  text.addStructure("cavity", "blood", "[\"cavity_0\", \"cavity_1\"]", 2, "role = \"lv_cavity\"");
  const NamedMeshes meshes{{"wall_0", shared(heart.wall)},
                           {"wall_1", shared(mapped(heart.wall, heart.map))},
                           {"cavity_0", shared(heart.cavity)},
                           {"cavity_1", shared(mapped(heart.cavity, heart.map))}};
  Scene scene = parseScene(text.text(), "in memory", meshes);
  scene.truth.function = scene.truth.tracks = true;
  return scene;
}

// The heart half-way through its beat, and its tracks against the map.
struct Measured {
  FunctionFrame now;
  double worst_place_m = 0, mean_place_m = 0;  // of tracks off the map
};

Measured measured(const TwoPhases& heart) {
  const Scene scene = sceneOf(heart);
  const MeshMotion motion(scene);
  const TruthMaker truth(scene, motion, {}, 0);
  const auto placed = [&](Vec3f p_m) { return 1e-3 * heart.map(1e3 * toDouble(p_m)); };
  Measured result;
  const FrameTruth frame = truth.at({0.5, 0.5, 0.5, 1});
  result.now = *frame.function;
  const FrameTruth rest = truth.at({0, 0, 0, 1});
  for (std::size_t i = 0; i < rest.tracks_m.size(); ++i) {
    const double off_m = length(toDouble(frame.tracks_m[i]) - placed(rest.tracks_m[i]));
    result.worst_place_m = std::max(result.worst_place_m, off_m);
    result.mean_place_m += off_m / static_cast<double>(rest.tracks_m.size());
  }
  EXPECT_GT(rest.tracks_m.size(), 500u);
  return result;
}

const Vec3d kMiddle{0, 0, 80};  // mm

// Incompressible: what is inside a radius grows by the same volume everywhere, r'^3 = r^3 + c.
TEST(HeartFunctionLaw, ABallThatInflates) {
  constexpr double kGrowth = 27.0 * 27.0 * 27.0 - 25.0 * 25.0 * 25.0;  // mm^3
  const TwoPhases heart{support::icosphere(4, 25).moved(kMiddle),
                        support::icosphere(4, 35).moved(kMiddle), [](Vec3d p) {
                          const double r = length(p - kMiddle);
                          return kMiddle + std::cbrt(1 + kGrowth / (r * r * r)) * (p - kMiddle);
                        }};
  const Measured m = measured(heart);
  EXPECT_LT(m.worst_place_m, 0.1e-3);
  const double stretch = std::cbrt(1 + kGrowth / (30.0 * 30.0 * 30.0));
  EXPECT_NEAR(m.now.global_longitudinal_strain, stretch - 1, 2e-3);
  int seen = 0;
  for (const SegmentStrain& s : m.now.segments) {
    if (std::isnan(s.thickness_mm)) continue;
    ++seen;
    EXPECT_NEAR(s.longitudinal, stretch - 1, 5e-3);
    EXPECT_NEAR(s.circumferential, stretch - 1, 5e-3);
    EXPECT_NEAR(s.radial, (std::cbrt(35.0 * 35 * 35 + kGrowth) - 27) / 10 - 1, 2e-3);
    EXPECT_NEAR(s.thickness_mm, std::cbrt(35.0 * 35 * 35 + kGrowth) - 27, 0.3);
  }
  EXPECT_EQ(seen, 17);
}

// A tube about z from `base` to `end` with a flat base and a cone for an apex, mm.
Mesh pointedTube(double radius, double base, double end, double tip) {
  constexpr int kTurns = 48, kRings = 25;
  Mesh m;
  for (int ring = 0; ring < kRings; ++ring)
    for (int i = 0; i < kTurns; ++i) {
      const double turn = 2 * std::numbers::pi * i / kTurns;
      m.points.push_back({radius * std::cos(turn), radius * std::sin(turn),
                          base + (end - base) * ring / (kRings - 1)});
    }
  m.points.push_back({0, 0, base});
  m.points.push_back({0, 0, tip});
  const auto at = [](int ring, int i) {
    return static_cast<std::uint32_t>(ring * kTurns + i % kTurns);
  };
  const std::uint32_t middle = at(kRings, 0), apex = middle + 1;
  for (int i = 0; i < kTurns; ++i) {
    m.triangles.push_back({middle, at(0, i + 1), at(0, i)});
    m.triangles.push_back({apex, at(kRings - 1, i), at(kRings - 1, i + 1)});
    for (int ring = 0; ring + 1 < kRings; ++ring) {
      m.triangles.push_back({at(ring, i), at(ring, i + 1), at(ring + 1, i + 1)});
      m.triangles.push_back({at(ring, i), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  }
  return m;
}

// Turned so that the apex looks at the probe.
Vec3d toProbe(Vec3d p) {
  return {p.x, -p.y, 130 - p.z};
}

TwoPhases tubeHeart(const Map& in_heart) {
  return {mapped(pointedTube(20, -2, 80, 90), toProbe),
          mapped(pointedTube(30, 0, 88, 104), toProbe),
          [in_heart](Vec3d p) { return toProbe(in_heart(toProbe(p))); }};
}

// toProbe is its own inverse, so the map above is the heart's own seen from the probe.
TEST(HeartFunctionLaw, ATubeThatTwistsAndShortens) {
  constexpr double kShorter = 0.8, kTurn = 0.2 / 92;  // rad per mm at rest
  const TwoPhases heart = tubeHeart([](Vec3d p) {
    const double a = kTurn * p.z, c = std::cos(a), s = std::sin(a);
    return Vec3d{c * p.x - s * p.y, s * p.x + c * p.y, kShorter * p.z};
  });
  const Measured m = measured(heart);
  const double along = std::hypot(kShorter, 25 * kTurn) - 1;  // in the middle of the straight wall
  for (std::size_t s = 6; s < 12; ++s)
    EXPECT_NEAR(m.now.segments[s].longitudinal, along, 2e-3) << kAhaNames[s];
  EXPECT_NEAR(m.now.twist_deg, 0.2 * 180 / std::numbers::pi, 0.5);
  EXPECT_NEAR(m.now.length_mm, kShorter * 92, 0.01);
  EXPECT_NEAR(m.now.base_descent_mm, (1 - kShorter) * 2, 0.01);  // beyond the fixed plane
  EXPECT_LT(m.mean_place_m, 0.1e-3);
}

TEST(HeartFunctionLaw, AHeartThatIsMovedAsAWholeHasNoStrain) {
  const Vec3d axis = normalised(Vec3d{1, 2, -1});
  const TwoPhases heart = tubeHeart([axis](Vec3d p) {  // Rodrigues' rotation by 20 degrees
    const double a = 20 * std::numbers::pi / 180;
    return std::cos(a) * p + std::sin(a) * cross(axis, p) +
           (1 - std::cos(a)) * dot(axis, p) * axis + Vec3d{3, -4, 5};
  });
  const Measured m = measured(heart);
  for (const SegmentStrain& s : m.now.segments)
    for (const double strain : {s.longitudinal, s.radial, s.circumferential})
      EXPECT_FALSE(std::abs(strain) > 1e-5) << strain;  // a segment may have no wall
  EXPECT_LT(std::abs(m.now.global_longitudinal_strain), 1e-5);
  EXPECT_LT(std::abs(m.now.twist_deg), 0.01);
  EXPECT_LT(m.worst_place_m, 1e-6);
  EXPECT_NEAR(m.now.sphericity, m.now.volume_ml / (std::numbers::pi / 6 * 92 * 92 * 92 * 1e-3),
              1e-4);
}

// Rows of a linear map that moves and turns, about the middle of the ball, mm.
Vec3d moved(Vec3d p, double part) {
  const Vec3d d = p - kMiddle;
  return p +
         part * (Vec3d{-0.1 * d.x + 0.05 * d.y, 0.08 * d.y - 0.04 * d.z, 0.06 * d.x + 0.1 * d.z} +
                 Vec3d{2, -1, 3});
}

// The inverse of `moved`, by its fixed point: the map is near to the identity.
Vec3d cameFrom(Vec3d p, double part) {
  Vec3d q = p;
  for (int i = 0; i < 60; ++i) q = q + (p - moved(q, part));
  return q;
}

TEST(HeartFunctionLaw, ChannelsOfAnAffineMotionAreItsOwn) {
  Scene scene =
      sceneOf({support::icosphere(3, 25).moved(kMiddle), support::icosphere(3, 35).moved(kMiddle),
               [](Vec3d p) { return moved(p, 1); }});
  scene.truth = {};
  scene.output.channels = {Channel::displacement_lateral, Channel::velocity_lateral};
  const MeshMotion motion(scene);
  const TruthMaker maker(scene, motion, {}, 0);
  constexpr double kPhase = 0.3, kStep = 0.01,
                   kBeat_s = 0.8;  // linear: the part is twice the phase
  const FrameTruth truth = maker.at({kPhase, kPhase - kStep, kPhase + kStep, 2 * kStep * kBeat_s});
  int seen = 0;
  for (int line = 0; line < scene.probe.lines; ++line) {
    const LineGeometry g = lineGeometry(scene.probe, line);
    for (int k = 0; k < scene.probe.samples; ++k) {
      const auto i = static_cast<std::size_t>(line * scene.probe.samples + k);
      const bool tissue = truth.sample_ids[i] == 1;
      EXPECT_EQ(std::isnan(truth.motion.displacement_mm[0][i]), !tissue);
      if (!tissue) continue;
      ++seen;
      const double path_m = scene.probe.min_depth_m + (k + 0.5) * scene.probe.sampleSpacing();
      const Vec3d now = 1e3 * (g.origin + path_m * g.direction), was = cameFrom(now, 2 * kPhase);
      const Vec3d by = now - was, speed = (2 / kBeat_s) * (moved(was, 1) - was);
      const double expected[] = {by.x, by.z, by.y}, speeds[] = {speed.x, speed.z, speed.y};
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(static_cast<double>(truth.motion.displacement_mm[a][i]), expected[a], 3e-3);
        EXPECT_NEAR(static_cast<double>(truth.motion.velocity_mm_s[a][i]), speeds[a], 2e-2);
      }
    }
  }
  EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace echocine
