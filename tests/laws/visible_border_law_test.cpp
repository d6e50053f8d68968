// Visible points of contours: where planted levels on both sides differ, and nowhere else.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "frame/simulator.h"
#include "motion/heart/heart_scene.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "truth/visible_border.h"

namespace echocine::visible_border_law {
namespace {

constexpr double kRange_db = 60;

Probe sector() {
  Probe probe;
  probe.first_angle_rad = -0.7, probe.last_angle_rad = 0.7;
  probe.min_depth_m = 2e-3, probe.max_depth_m = 0.12;
  probe.lines = 256, probe.samples = 512;
  return probe;
}

// Samples by a level in dB of each place.
template <typename Level>
std::vector<float> greysBy(const Probe& probe, const Level& level) {
  const ScanGeometry geometry(probe);
  std::vector<float> greys;
  for (int i = 0; i < probe.lines; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    for (int k = 0; k < probe.samples; ++k)
      greys.push_back(static_cast<float>(
          level(line.origin + geometry.sampleDepth(k) * line.direction) / kRange_db));
  }
  return greys;
}

Contour circle(double radius_m, Vec3d centre, bool reversed) {
  Contour contour;
  contour.closed = true;
  for (int i = 0; i < 200; ++i) {
    const double angle_rad = (reversed ? -1 : 1) * 2 * std::numbers::pi * i / 200;
    contour.points_m.push_back(centre +
                               radius_m * Vec3d{std::cos(angle_rad), 0, std::sin(angle_rad)});
  }
  return contour;
}

TEST(VisibleBorderLaw, AStepOnOneSideOfABallIsSeenThereAlone) {
  const Probe probe = sector();
  const Vec3d centre{0, 0, 0.06};
  constexpr double kRadius_m = 15e-3;
  for (const double step_db : {6.0, -6.0}) {
    const std::vector<float> greys = greysBy(probe, [&](Vec3d p) {
      return length(p - centre) < kRadius_m ? 20.0 : 20 + (p.x < 0 ? step_db : step_db / 4);
    });
    for (const bool reversed : {false, true}) {
      const Contour ball = circle(kRadius_m, centre, reversed);
      const std::vector<char> visible = visiblePoints(ball, false, probe, greys, kRange_db);
      ASSERT_EQ(visible.size(), ball.points_m.size());
      for (std::size_t i = 0; i < visible.size(); ++i) {
        if (ball.points_m[i].x < -4e-3) {
          EXPECT_EQ(visible[i], 1) << i;
        }
        if (ball.points_m[i].x > 4e-3) {
          EXPECT_EQ(visible[i], 0) << i;
        }
      }
    }
  }
}

TEST(VisibleBorderLaw, NothingOutsideTheSectorIsSeen) {
  const Probe probe = sector();
  const Vec3d centre = 0.08 * Vec3d{std::sin(0.7), 0, std::cos(0.7)};
  const Contour ball = circle(15e-3, centre, false);
  const std::vector<float> greys =
      greysBy(probe, [&](Vec3d p) { return length(p - centre) < 15e-3 ? 10.0 : 40.0; });
  const std::vector<char> visible = visiblePoints(ball, false, probe, greys, kRange_db);
  int inside = 0;
  for (std::size_t i = 0; i < visible.size(); ++i) {
    const Vec3d p = ball.points_m[i];
    if (!inScanArea(probe, p.x, p.z)) {
      EXPECT_EQ(visible[i], 0) << i;
    }
    inside += visible[i];
  }
  EXPECT_GT(inside, 80);
  EXPECT_LT(inside, 120);
}

TEST(VisibleBorderLaw, ASheetIsSeenWhereItExceedsBothSides) {
  const Probe probe = sector();
  Contour sheet;
  for (int i = 0; i <= 120; ++i) sheet.points_m.push_back({1e-3 * (0.5 * i - 30), 0, 0.06});
  const std::vector<float> greys = greysBy(probe, [&](Vec3d p) {
    return std::abs(p.z - 0.06) < 0.5e-3 && p.x < 0 ? 26.0 : p.z > 0.06 ? 20.0 : 18.0;
  });
  const std::vector<char> visible = visiblePoints(sheet, true, probe, greys, kRange_db);
  for (std::size_t i = 0; i < visible.size(); ++i) {
    if (sheet.points_m[i].x < -4e-3) {
      EXPECT_EQ(visible[i], 1) << i;
    }
    if (sheet.points_m[i].x > 4e-3) {
      EXPECT_EQ(visible[i], 0) << i;
    }
  }
}

// Also a sheet that is cut in a ring, such as a funnel of leaflets in a short axis.
TEST(VisibleBorderLaw, ARingOfASheetIsSeenWhereItExceedsBothSides) {
  const Probe probe = sector();
  Contour ring;
  ring.closed = true;
  constexpr double kRadius_m = 0.015;
  const Vec3d middle{0, 0, 0.06};
  for (int i = 0; i < 120; ++i) {
    const double a = 2 * std::numbers::pi * i / 120;
    ring.points_m.push_back(middle + kRadius_m * Vec3d{std::cos(a), 0, std::sin(a)});
  }
  const std::vector<float> greys = greysBy(probe, [&](Vec3d p) {
    return std::abs(length(p - middle) - kRadius_m) < 0.5e-3 && p.x < 0 ? 26.0 : 18.0;
  });
  const std::vector<char> visible = visiblePoints(ring, true, probe, greys, kRange_db);
  for (std::size_t i = 0; i < visible.size(); ++i) {
    if (ring.points_m[i].x < -5e-3) {
      EXPECT_EQ(visible[i], 1) << i;
    }
    if (ring.points_m[i].x > 5e-3) {
      EXPECT_EQ(visible[i], 0) << i;
    }
  }
}

double lostAt(const Simulator& simulator, double time_s) {
  const Frame frame = simulator.frame(time_s);
  double lost = 0, all = 0;
  for (const Contour& contour : frame.truth->contours) {
    EXPECT_EQ(contour.visible.size(), contour.points_m.size());
    if (roleOf(simulator.scene().structures[index(contour.surface)]) != Role::lv_cavity) continue;
    for (const char seen : contour.visible) lost += seen == 0, ++all;
  }
  EXPECT_GT(all, 50);
  return lost / all;
}

Scene scannerHeart(heart::View view) {
  Scene scene = heart::heartScene(heart::parametersFrom({}), view, 6, Look::scanner);
  scene.probe.lines = 96;
  scene.probe.samples = 384;
  scene.truth.contours = true;
  return scene;
}

TEST(VisibleBorderLaw, AShareOfTheEndocardiumDropsOutMoreInNoise) {
  Scene noise = scannerHeart(heart::View::a4c);
  noise.artefacts.noise_db = -30, noise.artefacts.haze_db = -6;
  const double lost = lostAt(Simulator(scannerHeart(heart::View::a4c)), 0),
               noisy = lostAt(Simulator(std::move(noise)), 0);
  std::printf("  endocardium lost: %.3f, with more noise and haze %.3f\n", lost, noisy);
  EXPECT_LT(lost, 0.4);
  EXPECT_GT(noisy, lost + 0.05);
}

// Subendocardial fibres are longitudinal. In apical views they run along the beam, in parasternal
// views across it. Mean of end-diastole and end-systole.
double lostBorder(heart::View view, bool fibres) {
  Scene scene = scannerHeart(view);
  if (!fibres) scene.speckle.anisotropy_db = 0;
  const double es_s =
      scene.motion.end_systole_phase.value_or(0.35) / scene.acquisition.heart_rate_hz;
  const Simulator simulator(std::move(scene));
  return (lostAt(simulator, 0) + lostAt(simulator, es_s)) / 2;
}

TEST(VisibleBorderLaw, FibresAlongTheBeamLoseBordersOfApicalViews) {
  const double apical = lostBorder(heart::View::a4c, true),
               apical_even = lostBorder(heart::View::a4c, false),
               parasternal = lostBorder(heart::View::plax, true),
               parasternal_even = lostBorder(heart::View::plax, false);
  std::printf("  lost: a4c %.3f, plax %.3f; without fibres %.3f, %.3f\n", apical, parasternal,
              apical_even, parasternal_even);
  EXPECT_GT(apical, 0.15);
  EXPECT_LT(apical, 0.4);
  EXPECT_GT(apical - apical_even, 0.05);
  EXPECT_GT(apical - apical_even, parasternal - parasternal_even);
}

}  // namespace
}  // namespace echocine::visible_border_law
