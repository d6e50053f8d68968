// Leaflets with thickness: bodies about their meshes, which change the picture and nothing else.

#include <gtest/gtest.h>

#include <cmath>

#include "frame/simulator.h"
#include "geometry/plane_slice.h"
#include "plan/effect_plan.h"
#include "plan/loop_plan.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "scene/scene_reader.h"
#include "speckle/sheet_points.h"
#include "support/loop_scene.h"
#include "support/picture_only.h"
#include "support/thick_leaflets.h"

namespace echocine {
namespace {

using support::Thick, support::thickLeaflets;

// The ball's flat leaflet, across the beam and at rest, as a mitral one. The folder holds its
// meshes.
Scene flatLeaflet(const support::TempFolder& folder, double thickness_m) {
  Scene scene = readScene(support::writeBall(folder, support::ballScene(4)));
  scene.structures.back().role = Role::mitral_valve;
  scene.leaflets.thickness_m = thickness_m;
  return scene;
}

// Law: a flat sheet at rest becomes a slab of the thickness asked for.
TEST(LeafletBodies, AFlatSheetIsAsThickAsAsked) {
  for (const double thickness_m : {0.4e-3, 1.5e-3, 3e-3}) {
    const support::TempFolder folder;
    const Scene scene = flatLeaflet(folder, thickness_m);
    const Thick thick(scene);
    PlaneSlice slice(thick.bodies.surfaces(), scene.probe);
    slice.update(thick.at(0.2));
    const auto leaflet = static_cast<SurfaceId>(scene.structures.size() - 1);
    ASSERT_TRUE(thick.bodies.isBody(leaflet));
    std::vector<double> met_m;
    for (const Crossing& crossing : slice.lines()[16].crossings)
      if (crossing.surface == leaflet) {
        EXPECT_EQ(crossing.entering, met_m.empty());
        met_m.push_back(crossing.distance_m * std::abs(crossing.normal.z));
      }
    ASSERT_EQ(met_m.size(), 2u);
    const double cosine = lineGeometry(scene.probe, 16).direction.z;
    EXPECT_NEAR((met_m[1] - met_m[0]) * cosine, thickness_m, 1e-7);
  }
}

// Law: over a flat sheet the volume is the sum over its faces of their area times the mean
// thickness at their corners, and the rim adds nothing to it.
TEST(LeafletBodies, AFlatSheetHasTheVolumeOfPrisms) {
  const support::TempFolder folder;
  const Scene scene = flatLeaflet(folder, 2e-3);
  const Thick thick(scene);
  SurfaceFrame sheet;
  thick.motion.frameAt(0, sheet, false);
  const std::size_t s = scene.structures.size() - 1;
  const auto id = static_cast<SurfaceId>(s);
  std::vector<Vec3f> front_m;
  thick.bodies.toFront(id, sheet.positions_m[s], front_m);
  double prisms_m3 = 0;
  for (const Triangle& t : thick.motion.surfaces()[s].triangles) {
    const std::vector<Vec3f>& p = sheet.positions_m[s];
    const double area_m2 =
        0.5 * static_cast<double>(length(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])));
    for (const std::uint32_t v : t)
      prisms_m3 += area_m2 / 3 * 2 * static_cast<double>(length(front_m[v]));
  }
  const double volume_m3 = enclosedVolume(thick.bodies.surfaces()[s], thick.at(0).positions_m[s]);
  EXPECT_NEAR(volume_m3, prisms_m3, 1e-4 * prisms_m3);
}

// Law: thickest at the free edge, which moves most; thinnest at the hinge; never above twice the
// thickness asked for. Few vertices are thinner than half of it.
TEST(LeafletBodies, AreThickerTowardsTheFreeEdge) {
  constexpr double kThickness_m = 1.5e-3;
  const Scene scene = thickLeaflets({}, kThickness_m);
  const Thick thick(scene);
  SurfaceFrame sheet;
  thick.motion.frameAt(0.5, sheet, false);
  for (const SurfaceTopology& body : thick.bodies.surfaces()) {
    if (!thick.bodies.isBody(body.id)) continue;
    std::vector<Vec3f> front_m;
    thick.bodies.toFront(body.id, sheet.positions_m[index(body.id)], front_m);
    double most_m = 0, thin = 0, count = 0;
    for (const Vec3f f : front_m) {
      const double full_m = 2 * static_cast<double>(length(f));
      most_m = std::max(most_m, full_m);
      thin += full_m < 0.49 * kThickness_m;
      count += 1;
    }
    EXPECT_LE(most_m, 2 * kThickness_m);
    EXPECT_GT(most_m, 1.2 * kThickness_m) << scene.structures[index(body.id)].name;
    EXPECT_LT(thin, 0.2 * count) << scene.structures[index(body.id)].name;
  }
}

TEST(LeafletBodies, GiveTheSheetsBack) {
  const Scene scene = thickLeaflets({}, 1.5e-3);
  const Thick thick(scene);
  SurfaceFrame frame;
  LeafletBodies::Sheets sheets;
  for (const double phase : {0.0, 0.4, 0.6}) {
    thick.motion.frameAt(phase, frame);
    const SurfaceFrame before = frame;
    thick.bodies.thicken(frame, sheets);
    EXPECT_NE(frame.positions_m, before.positions_m);
    thick.bodies.thin(frame, sheets);
    EXPECT_EQ(frame.positions_m, before.positions_m);
    EXPECT_EQ(frame.normals, before.normals);
  }
}

// Law: scatterers fill the body evenly: a uniform place through it has the deviation 1/sqrt(12).
TEST(LeafletBodies, ScatterersFillTheBody) {
  constexpr double kThickness_m = 2e-3;
  const support::TempFolder folder;
  Scene scene = flatLeaflet(folder, kThickness_m);
  scene.speckle.on = true;
  const MeshMotion motion(scene);
  const SheetPoints on_sheet(scene, motion, 0),
      in_body(scene, motion, 0, {.leaflets = std::make_shared<const LeafletBodies>(scene, motion)});
  ASSERT_EQ(on_sheet.count(), in_body.count());
  SurfaceFrame frame;
  motion.frameAt(0.3, frame);
  std::vector<Vec3f> sheet_m, body_m;
  on_sheet.at(frame, sheet_m);
  in_body.at(frame, body_m);
  // The outline's rows are thinner.
  const std::vector<Vec3f>& corners = frame.positions_m.back();
  Box box;
  for (const Vec3f p : corners) box.add(toDouble(p));
  const double inner_m = 0.25 * (box.hi.x - box.lo.x);
  double sum = 0, squares = 0, count = 0;
  for (std::size_t p = 0; p < body_m.size(); ++p) {
    const Vec3d by = toDouble(body_m[p] - sheet_m[p]);
    ASSERT_NEAR(by.x, 0, 1e-8);
    ASSERT_LE(std::abs(by.z), 0.5 * kThickness_m + 1e-8);
    const Vec3d at = toDouble(sheet_m[p]);
    if (std::abs(at.x - 0.5 * (box.lo.x + box.hi.x)) > inner_m ||
        std::abs(at.y - 0.5 * (box.lo.y + box.hi.y)) > inner_m)
      continue;
    sum += by.z / kThickness_m;
    squares += std::pow(by.z / kThickness_m, 2);
    count += 1;
  }
  ASSERT_GT(count, 300);
  EXPECT_NEAR(sum / count, 0, 4 / std::sqrt(12 * count));
  EXPECT_NEAR(std::sqrt(squares / count), 1 / std::sqrt(12.0), 0.1 / std::sqrt(12.0));
}

// A leaflet is left out if its box over the loop does not meet the sector: the box holds the body.
TEST(LeafletBodies, TheBoxOverTheLoopHoldsTheBody) {
  const Scene scene = thickLeaflets({}, 8e-3, 4e-3);
  const Thick thick(scene);
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    if (!hasThickness(scene, scene.structures[s])) continue;
    const Box& box = thick.motion.loopBoxes()[s];
    for (const double phase : {0.0, 0.2, 0.45, 0.7, 0.9}) {
      const SurfaceFrame frame = thick.at(phase);
      for (const Vec3f p : frame.positions_m[s])
        ASSERT_TRUE(box.contains(toDouble(p))) << scene.structures[s].name << ' ' << phase;
    }
  }
}

// Law: a sheet along the beam echoes by its faces alone, at 90 degrees next to nothing; its body
// scatters. Beside an open leaflet of an apical view this is what shows it.
TEST(LeafletBodies, AnOpenLeafletOfAnApicalViewShows) {
  const auto brightest = [](double thickness_m) {
    Scene scene = thickLeaflets({}, thickness_m);
    scene.speckle.on = false;
    scene.artefacts = {};
    scene.probe.lines = 128;
    scene.probe.samples = 384;
    const Simulator simulator(scene);
    SurfaceFrame frame;
    simulator.motion().frameAt(0.55, frame);
    const std::vector<Vec3f>& leaflet_m =
        frame.positions_m[index(*structureOf(scene, Role::mitral_valve))];
    // The free edge, farthest from the hinges: nearest the probe, at the plane.
    Vec3f tip{0, 0, 1};
    for (const Vec3f p : leaflet_m)
      if (std::abs(p.y) < 2e-3f && p.z < tip.z) tip = p;
    const Intensities made = simulator.frame(0.55 / scene.acquisition.heart_rate_hz).intensities;
    double most = 0;
    const double spacing_m = scene.probe.sampleSpacing();
    for (int line = 0; line < scene.probe.lines; ++line)
      for (int k = 0; k < scene.probe.samples; ++k) {
        const LineGeometry g = lineGeometry(scene.probe, line);
        const double path_m = scene.probe.min_depth_m + (k + 0.5) * spacing_m;
        const Vec3d at = g.origin + path_m * g.direction;
        if (length(at - toDouble(tip) - Vec3d{0, 0, 4e-3}) > 2e-3) continue;
        most = std::max(most, static_cast<double>(
                                  made[static_cast<std::size_t>(line * scene.probe.samples + k)]));
      }
    return most;
  };
  EXPECT_GT(brightest(1.5e-3), 4 * brightest(0));
}

// A sheet of the impedance of all around it reflects nothing; its body may still scatter.
TEST(LeafletBodies, ShowByTheirBackscatterAlone) {
  const support::TempFolder folder;
  for (const double thickness_m : {0.0, 2e-3}) {
    Scene scene = flatLeaflet(folder, thickness_m);
    for (Medium& medium : scene.media) {
      medium.impedance_kg_m2_s = 1.6e6;
      medium.sound_speed_m_s = 1540;
    }
    const Simulator simulator(scene);
    EXPECT_EQ(simulator.plan().left_out[scene.structures.size() - 1], thickness_m == 0);
  }
}

TEST(LeafletBodies, ChangeThePictureAndNoTruth) {
  support::expectPictureOnly(thickLeaflets({}, 0), thickLeaflets({}, 1.5e-3));
}

// Law: the mesh of a cusp is the middle of its body while it opens and closes. Cusps are a few rows
// of vertices, whose outline is halved, so few exceed the thickness asked for.
TEST(LeafletBodies, CuspsOpenAsTheirMeshes) {
  constexpr double kCusp_m = 0.45e-3;
  const Scene scene = thickLeaflets({}, 0, kCusp_m);
  const Thick thick(scene);
  int cusps = 0;
  SurfaceFrame sheet;
  std::vector<Vec3f> front_m;
  for (const double phase : {0.0, 0.15, 0.6}) {
    thick.motion.frameAt(phase, sheet, false);
    const SurfaceFrame body = thick.at(phase);
    for (const SurfaceTopology& surface : thick.bodies.surfaces()) {
      const std::size_t s = index(surface.id);
      if (!thick.bodies.isBody(surface.id)) continue;
      const Role role = roleOf(scene.structures[s]);
      EXPECT_TRUE(role == Role::aortic_valve || role == Role::pulmonary_valve);
      ++cusps;
      thick.bodies.toFront(surface.id, sheet.positions_m[s], front_m);
      double most_m = 0;
      const std::size_t n = front_m.size();
      for (std::size_t v = 0; v < n; ++v) {
        most_m = std::max(most_m, 2 * static_cast<double>(length(front_m[v])));
        const Vec3f middle =
            0.5f * (body.positions_m[s][v] + body.positions_m[s][v + n]) - sheet.positions_m[s][v];
        ASSERT_LT(length(middle), 1e-7f);
      }
      EXPECT_LE(most_m, 2 * kCusp_m);
      EXPECT_GT(most_m, 0.9 * kCusp_m) << scene.structures[s].name;
    }
  }
  EXPECT_EQ(cusps, 3 * 6);
}

TEST(LeafletBodies, AreOfValvesAndOfLooksButThePaper) {
  Scene scene = thickLeaflets({}, 0);
  EXPECT_FALSE(planEffects(scene).leaflets);
  scene.leaflets.thickness_m = 1e-3;
  EXPECT_TRUE(planEffects(scene).leaflets);
  int thick = 0;
  for (const Structure& structure : scene.structures) thick += hasThickness(scene, structure);
  EXPECT_EQ(thick, 4);
  scene.leaflets.cusp_m = 0.5e-3;
  thick = 0;
  for (const Structure& structure : scene.structures) thick += hasThickness(scene, structure);
  EXPECT_EQ(thick, 10);
  support::expectOfLooksButPaper(&LeafletSettings::thickness_m);
}

}  // namespace
}  // namespace echocine
