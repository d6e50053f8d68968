// Truth stands where the picture shows things, with travel times and with bent rays. Oracles:
// closed forms in the probe's plane, and echoes of the picture itself.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "frame/picture_grid.h"
#include "frame/simulator.h"
#include "plan/loop_plan.h"
#include "scene/scan_geometry.h"
#include "support/scene_text.h"

namespace echocine::shown_truth_law {
namespace {

using support::Mesh;
using support::SceneText;

constexpr double kRadius_m = 0.015;
const Vec3d kMiddle{-0.012, 0, 0.1};

std::shared_ptr<const TriangleMesh> shared(const Mesh& mesh) {
  return std::make_shared<TriangleMesh>(TriangleMesh{mesh.points, mesh.triangles, {}, {}});
}

// A plane in the probe frame, m, with the sound speeds before and behind it.
struct Face {
  Vec3d on, normal;  // unit, towards the probe
  double before_m_s, behind_m_s;
};

// Snell's law in three dimensions by the tangential part of the direction.
Vec3d bent(Vec3d direction, const Face& face) {
  const Vec3d along = direction - dot(direction, face.normal) * face.normal;
  const Vec3d tangential = (face.behind_m_s / face.before_m_s) * along;
  return tangential - std::sqrt(1 - dot(tangential, tangential)) * face.normal;
}

// Where sound is after a path of `path_m` in the direction of an angle.
Vec3d placeBehind(const std::vector<Face>& faces, double angle_rad, double path_m) {
  Vec3d at, direction{std::sin(angle_rad), 0, std::cos(angle_rad)};
  for (const Face& face : faces) {
    const double to_m = dot(face.on - at, face.normal) / dot(direction, face.normal);
    if (to_m >= path_m) break;
    at = at + to_m * direction;
    path_m -= to_m;
    direction = bent(direction, face);
  }
  return at + path_m * direction;
}

// The place of the heart that the picture shows at an angle and a depth, m.
using Shows = std::function<Vec3d(double angle_rad, double depth_m)>;

const std::vector<Face>& wedge() {
  static const std::vector<Face> faces{
      {{0, 0, 0.03}, normalised(Vec3d{-0.10, 0.06, -1}), 1584, 1440},
      {{0, 0, 0.06}, normalised(Vec3d{0.35, -0.05, -1}), 1440, 1584}};
  return faces;
}

Vec3d shownByWedge(double angle_rad, double depth_m) {
  return placeBehind(wedge(), angle_rad, depth_m);
}

Vec3d shownByTime(double angle_rad, double depth_m) {
  const double path_m = depth_m * 1584 / 1540;
  return {path_m * std::sin(angle_rad), 0, path_m * std::cos(angle_rad)};
}

// A block whose two faces across the beam are those of the wedge; mm.
Mesh wedgeMesh() {
  Mesh m = support::box({-90, -60, 0}, {90, 60, 1});
  for (Vec3d& p : m.points) {
    const Face& face = wedge()[p.z > 0.5 ? 1 : 0];
    const Vec3d on = 1e3 * face.on;
    p.z = on.z - (p.x * face.normal.x + p.y * face.normal.y) / face.normal.z;
  }
  return m;
}

// A ball that grows by a fifth in half a beat, behind the wedge or not.
Scene ballScene(bool behind_wedge) {
  SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}, {"interpolation", "\"linear\""}};
  text.probe["depth_mm"] = "160";
  text.probe["lines"] = "128";
  text.probe["samples"] = "512";
  text.acquisition = {{"heart_rate_bpm", "60"}, {"frame_rate_hz", "10"}};
  text.output = {{"width", "400"}, {"height", "300"}, {"ecg", "false"}};
  text.media = support::kGelOilMeat;
  text.background = "gel";
  text.accuracy["interface_echo"] = "\"centre\"";
  text.effects["beam_width"] = "\"off\"";
  text.addStructure("ball", "meat", "[\"ball_0\", \"ball_1\"]", 2);
  if (behind_wedge) text.addStructure("wedge", "oil", "\"wedge\"", 1);
  text.effects[behind_wedge ? "refraction" : "travel_time"] = behind_wedge ? "\"auto\"" : "\"on\"";
  const Mesh ball = support::icosphere(5, 1e3 * kRadius_m);
  const NamedMeshes meshes{{"ball_0", shared(ball.moved(1e3 * kMiddle))},
                           {"ball_1", shared(ball.scaled(1.2).moved(1e3 * kMiddle))},
                           {"wedge", shared(wedgeMesh())}};
  Scene scene = parseScene(text.text(), "in memory", meshes);
  scene.truth.labels = scene.truth.contours = true;
  scene.output.channels = {Channel::structure, Channel::displacement_lateral,
                           Channel::displacement_axial, Channel::displacement_elevation};
  return scene;
}

struct BallTruth {
  Scene scene;
  Frame frame;
  double radius_m = 0;

  BallTruth(bool behind_wedge, double time_s, double growth) : radius_m(growth * kRadius_m) {
    const Simulator simulator(ballScene(behind_wedge));
    EXPECT_EQ(simulator.plan().effects.refraction, behind_wedge);
    frame = simulator.frame(time_s);
    scene = simulator.scene();
  }
};

// Twice the pixels that both take for the ball over those that either does, added.
double dice(const BallTruth& ball, const Shows& shows) {
  const PictureGrid grid = pictureGrid(ball.scene);
  double both = 0, either = 0;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const double x = grid.xOf(column), z = grid.zOf(row);
      if (!inScanArea(ball.scene.probe, x, z)) continue;
      const Vec3d place = shows(std::atan2(x, z), std::hypot(x, z));
      const bool there = length(place - kMiddle) < ball.radius_m;
      const bool labelled =
          ball.frame.truth->labels[static_cast<std::size_t>(row * grid.width + column)] == 1;
      both += there && labelled;
      either += there + labelled;
    }
  return 2 * both / either;
}

// The ball's one contour: how far its points are from the closed form's boundary in depth, and the
// share of that boundary's area which it encloses.
void expectContour(const BallTruth& ball, const Shows& shows) {
  const Contour* found = nullptr;
  for (const Contour& c : ball.frame.truth->contours) {
    if (c.surface != SurfaceId{0}) continue;
    EXPECT_EQ(found, nullptr) << "more than one contour";
    found = &c;
  }
  ASSERT_NE(found, nullptr);
  EXPECT_TRUE(found->closed);
  double worst_m = 0, twice_area = 0;
  for (std::size_t i = 0; i < found->points_m.size(); ++i) {
    const Vec3d p = found->points_m[i], q = found->points_m[(i + 1) % found->points_m.size()];
    const double off_m =
        length(shows(std::atan2(p.x, p.z), std::hypot(p.x, p.z)) - kMiddle) - ball.radius_m;
    worst_m = std::max(worst_m, std::abs(off_m));
    twice_area += p.x * q.z - q.x * p.z;
  }
  double area = 0;
  constexpr double kStep_m = 1e-4;
  for (double x = -0.06; x < 0.06; x += kStep_m)
    for (double z = 0.06; z < 0.14; z += kStep_m)
      if (length(shows(std::atan2(x, z), std::hypot(x, z)) - kMiddle) < ball.radius_m)
        area += kStep_m * kStep_m;
  std::printf("contour of %zu points: %.4f mm off at most, area %.4f\n", found->points_m.size(),
              1e3 * worst_m, std::abs(twice_area) / 2 / area);
  EXPECT_LT(worst_m, 0.1e-3);
  EXPECT_NEAR(std::abs(twice_area) / 2 / area, 1, 0.005);
}

// The picture's own edge: on each line that meets the ball under less than 60 degrees, the
// brightest sample within 3 mm of the contour's near side.
void expectEdgeOfThePicture(const BallTruth& ball) {
  const Probe& probe = ball.scene.probe;
  const ScanGeometry geometry(probe);
  int lines = 0;
  double worst_m = 0;
  for (int line = 0; line < probe.lines; ++line) {
    double near_m = 1, far_m = 0;
    for (const Contour& c : ball.frame.truth->contours)
      for (const Vec3d p : c.points_m) {
        const auto at = geometry.beamPosition(p.x, p.z);
        if (c.surface != SurfaceId{0} || !at || std::abs(at->line - line) > 1e-6) continue;
        near_m = std::min(near_m, at->path_m);
        far_m = std::max(far_m, at->path_m);
      }
    if (far_m - near_m < ball.radius_m) continue;
    int brightest = 0;
    float most = -1;
    for (int k = 0; k < probe.samples; ++k) {
      const float y =
          ball.frame.intensities.values[static_cast<std::size_t>(line * probe.samples + k)];
      if (std::abs(geometry.sampleDepth(k) - near_m) > 3e-3 || y <= most) continue;
      most = y;
      brightest = k;
    }
    ++lines;
    worst_m = std::max(worst_m, std::abs(geometry.sampleDepth(brightest) - near_m));
  }
  std::printf("%d lines: the echo is %.3f mm off the contour at most\n", lines, 1e3 * worst_m);
  EXPECT_GT(lines, 20);
  EXPECT_LT(worst_m, 0.2e-3);
}

// x - middle of a place shown, over what the ball has grown by.
void expectMotion(const BallTruth& ball, const Shows& shows, double growth) {
  const Probe& probe = ball.scene.probe;
  const ScanGeometry geometry(probe);
  const auto& moved = ball.frame.truth->motion.displacement_mm;
  std::size_t counted = 0;
  double worst_mm = 0;
  for (int line = 0; line < probe.lines; ++line)
    for (int k = 0; k < probe.samples; ++k) {
      const auto at = static_cast<std::size_t>(line * probe.samples + k);
      const double angle = probe.first_angle_rad + line * geometry.cellWidth();
      const Vec3d place = shows(angle, geometry.sampleDepth(k));
      const double off_m = length(place - kMiddle) - ball.radius_m;
      if (off_m < -0.2e-3) {
        ASSERT_EQ(ball.frame.truth->sample_ids[at], 1u);
      }
      if (off_m > 0.2e-3) {
        ASSERT_NE(ball.frame.truth->sample_ids[at], 1u);
      }
      if (off_m > -0.2e-3) continue;
      const Vec3d by = (1 - 1 / growth) * (place - kMiddle);
      const Vec3d found{1e-3 * static_cast<double>(moved[0][at]),
                        1e-3 * static_cast<double>(moved[2][at]),
                        1e-3 * static_cast<double>(moved[1][at])};
      worst_mm = std::max(worst_mm, 1e3 * length(found - by));
      ++counted;
    }
  std::printf("%zu samples: displacement %.4f mm off at most\n", counted, worst_mm);
  EXPECT_GT(counted, 500u);
  EXPECT_LT(worst_mm, 0.02);
}

double straight(const BallTruth& ball) {
  return dice(ball, [](double angle, double depth) {
    return Vec3d{depth * std::sin(angle), 0, depth * std::cos(angle)};
  });
}

template <typename Shown>
void expectShownTruth(const BallTruth& ball, const Shown& shown) {
  const double share = dice(ball, shown);
  std::printf("Dice %.4f, of straight path lengths %.4f\n", share, straight(ball));
  EXPECT_GT(share, 0.995);
  expectContour(ball, shown);
  expectEdgeOfThePicture(ball);
}

TEST(ShownTruthLaw, OfTravelTimes) {
  expectShownTruth(BallTruth(false, 0, 1), shownByTime);
}

TEST(ShownTruthLaw, OfRaysThatAWedgeBendsOutOfThePlane) {
  expectShownTruth(BallTruth(true, 0, 1), shownByWedge);
}

TEST(ShownTruthLaw, MotionIsThatOfTheMaterialShown) {
  expectMotion({false, 0.5, 1.2}, shownByTime, 1.2);
  expectMotion({true, 0.5, 1.2}, shownByWedge, 1.2);
}

}  // namespace
}  // namespace echocine::shown_truth_law
