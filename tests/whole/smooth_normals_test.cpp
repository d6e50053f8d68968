// What smooth normals are for: incidence angles and echoes of coarse meshes against the true shape.

#include <gtest/gtest.h>

#include <array>

#include "scene/scan_geometry.h"
#include "whole/nested_spheres.h"

namespace echocine {
namespace {

using namespace support;

RayCrossings crossingsOf(const Scene& scene, int line) {
  const MeshMotion motion(scene);
  SurfaceFrame surfaces;
  motion.frameAt(0, surfaces);
  PlaneSlice slice(motion.surfaces(), scene.probe);
  slice.update(surfaces);
  return slice.lines()[static_cast<std::size_t>(line)];
}

// Largest angle between a crossing's normal and the radius through it, degrees, over all lines.
double worstNormal(const Scene& scene) {
  const MeshMotion motion(scene);
  SurfaceFrame surfaces;
  motion.frameAt(0, surfaces);
  PlaneSlice slice(motion.surfaces(), scene.probe);
  slice.update(surfaces);
  double worst = 0;
  for (int i = 0; i < scene.probe.lines; ++i) {
    const LineGeometry line = lineGeometry(scene.probe, i);
    for (const Crossing& c : slice.lines()[static_cast<std::size_t>(i)].crossings) {
      const Vec3d radial = normalised(line.origin + c.distance_m * line.direction - kSphereCentre);
      if (std::abs(dot(radial, line.direction)) < 0.3) continue;  // silhouettes: see facingNormal
      worst = std::max(worst, length(cross(c.normal, radial)));
    }
  }
  return degreesFromRadians(std::asin(worst));
}

// Meshes whose vertices lie on the sphere. Their triangles are not all alike, which tilts the limit
// surface in first order too, but far less.
TEST(SmoothNormals, OfAMeshedSphereTiltSeveralTimesLessThanItsFacets) {
  for (int level = 2; level <= 5; ++level) {
    const TempFolder folder;
    Scene scene = writeNestedSpheres(folder, "off", level);
    const double facet = worstNormal(scene);
    scene.accuracy.normals = Normals::smooth;
    const double smooth = worstNormal(scene);
    std::printf("%d triangles a sphere: facet normals off by up to %.3f degrees, smooth %.4f\n",
                20 << (2 * level), facet, smooth);
    EXPECT_LT(smooth, facet / 7);
  }
}

// Normals of all crossings of a coarse control mesh after some levels, line by line.
std::vector<RayCrossings> subdivided(const TempFolder& folder, int levels, Normals normals) {
  Scene scene = writeNestedSpheres(folder, "off", 1);
  scene.motion.subdivision = levels;
  scene.accuracy.normals = normals;
  const MeshMotion motion(scene);
  SurfaceFrame surfaces;
  motion.frameAt(0, surfaces);
  PlaneSlice slice(motion.surfaces(), scene.probe);
  slice.update(surfaces);
  return slice.lines();
}

// Largest tilt against the reference, degrees; silhouettes left out.
double worstTilt(const std::vector<RayCrossings>& lines, const std::vector<RayCrossings>& truth,
                 const Probe& probe) {
  double worst = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<Crossing>&a = lines[i].crossings, &b = truth[i].crossings;
    if (a.size() != b.size()) continue;
    const Vec3d direction = lineGeometry(probe, static_cast<int>(i)).direction;
    for (std::size_t k = 0; k < a.size(); ++k)
      if (std::abs(dot(b[k].normal, direction)) > 0.3)
        worst = std::max(worst, length(cross(a[k].normal, b[k].normal)));
  }
  return degreesFromRadians(std::asin(worst));
}

// Subdivision of one control mesh: facets tend to the limit surface in first order of the edge
// length, interpolated normals in second.
TEST(SmoothNormals, OfASubdividedBallConvergeInSecondOrder) {
  const TempFolder folder;
  const Probe probe = writeNestedSpheres(folder, "off", 1).probe;
  const auto truth = subdivided(folder, 7, Normals::smooth);
  double facet_before = 0, smooth_before = 0;
  for (int levels = 1; levels <= 4; ++levels) {
    const double facet = worstTilt(subdivided(folder, levels, Normals::facet), truth, probe);
    const double smooth = worstTilt(subdivided(folder, levels, Normals::smooth), truth, probe);
    std::printf("%d levels: facet normals off by up to %.3f degrees, smooth %.4f\n", levels, facet,
                smooth);
    EXPECT_LT(smooth, facet / (levels < 3 ? 3 : 10));
    if (levels > 2) {
      EXPECT_NEAR(facet_before / facet, 2, 0.6);
      EXPECT_GT(smooth_before / smooth, 3);
    }
    facet_before = facet;
    smooth_before = smooth;
  }
}

// Echoes of one frame against the closed form: root of the mean squared relative error, and the
// largest, over all interfaces met at under 60 degrees.
std::array<double, 2> echoErrors(const Scene& scene) {
  const MeshMotion motion(scene);
  SurfaceFrame surfaces;
  motion.frameAt(0, surfaces);
  PlaneSlice slice(motion.surfaces(), scene.probe);
  slice.update(surfaces);
  EffectPlan plan = planEffects(scene);
  plan.refraction = false;
  PolarFrame frame;
  traceFrame(slice, scene.probe, TraceSettings(scene, plan), planeRequest(scene, plan), frame);
  ExactRay ray(scene, false);
  double sum = 0, worst = 0;
  int count = 0;
  for (int i = 0; i < scene.probe.lines; ++i) {
    const ExactLine exact = ray.trace(lineGeometry(scene.probe, i));
    const std::vector<Echo>& echoes = frame.traces[static_cast<std::size_t>(i)].echoes;
    if (exact.worst_incidence_deg > 60 || echoes.size() + 1 != exact.pieces.size()) continue;
    for (std::size_t k = 0; k < echoes.size(); ++k) {
      const double error = std::abs(echoes[k].intensity / double(exact.pieces[k].echo) - 1);
      sum += error * error;
      worst = std::max(worst, error);
      ++count;
    }
  }
  EXPECT_GT(count, 300);
  return {std::sqrt(sum / count), worst};
}

TEST(SmoothNormals, EchoesOfNestedSpheresAreSeveralTimesNearerToTheClosedForm) {
  for (const int level : {3, 4, 5}) {
    const TempFolder folder;
    Scene scene = writeNestedSpheres(folder, "off", level);
    const auto facet = echoErrors(scene);
    scene.accuracy.normals = Normals::smooth;
    const auto smooth = echoErrors(scene);
    std::printf(
        "%d triangles a sphere: echoes with facets off by %.2f %% (worst %.1f %%), smooth %.3f %% "
        "(worst %.2f %%)\n",
        20 << (2 * level), 100 * facet[0], 100 * facet[1], 100 * smooth[0], 100 * smooth[1]);
    EXPECT_LT(smooth[0], facet[0] / 5);
    EXPECT_LT(smooth[1], facet[1] / 5);
  }
}

// A box of flat sides with sharp edges: smooth normals are the facets'.
TEST(SmoothNormals, OfFlatSidesChangeNothing) {
  const TempFolder folder;
  writeObj(box({-4, -3, 3}, {4, 3, 8}), folder / "box.obj");
  std::ofstream out(folder / "box.obj", std::ios::app);
  for (unsigned a = 0; a < 8; ++a)
    for (const unsigned bit : {1u, 2u, 4u})
      if (!(a & bit)) out << "t crease 2/1/0 " << a << ' ' << (a | bit) << " 10\n";
  out.close();
  SceneText text = SceneText::oneBox("blood");
  text.probe["lines"] = "101";
  for (const char* levels : {"0", "2"}) {
    text.motion["subdivision"] = levels;
    text.accuracy["normals"] = "\"facet\"";
    const Scene facet = readScene(folder.write("facet.toml", text.text()));
    text.accuracy["normals"] = "\"smooth\"";
    const Scene smooth = readScene(folder.write("smooth.toml", text.text()));
    for (const int line : {0, 20, 50, 73, 100}) {
      const RayCrossings a = crossingsOf(facet, line), b = crossingsOf(smooth, line);
      ASSERT_EQ(a.crossings.size(), b.crossings.size());
      EXPECT_EQ(a.crossings.size(), 2u);
      for (std::size_t i = 0; i < a.crossings.size(); ++i) {
        EXPECT_EQ(a.crossings[i].distance_m, b.crossings[i].distance_m);
        EXPECT_LT(length(a.crossings[i].normal - b.crossings[i].normal), 1e-6);
      }
    }
  }
}

// Integrated over the beam's cells: the sum over all lines against the same over a mesh 64 times
// finer. The sector is narrow enough for incidence to stay under 60 degrees.
TEST(SmoothNormals, CellEchoesUseThemToo) {
  const auto total = [](int level, Normals normals) {
    const TempFolder folder;
    Scene scene = writeNestedSpheres(folder, "off", level);
    scene.accuracy.normals = normals;
    scene.probe.first_angle_rad = radiansFromDegrees(-15);
    scene.probe.last_angle_rad = radiansFromDegrees(20);
    const MeshMotion motion(scene);
    SurfaceFrame surfaces;
    motion.frameAt(0, surfaces);
    PlaneSlice slice(motion.surfaces(), scene.probe);
    slice.update(surfaces);
    EffectPlan plan = planEffects(scene);
    plan.refraction = false;
    PolarFrame frame;
    traceFrame(slice, scene.probe, TraceSettings(scene, plan, EchoCells::contours),
               planeRequest(scene, plan), frame);
    double sum = 0;
    for (std::size_t i = 0; i < frame.cell_echoes.count; ++i) sum += frame.cell_echoes.intensity[i];
    return sum;
  };
  const double exact = total(6, Normals::smooth);
  const double facet = std::abs(total(3, Normals::facet) / exact - 1);
  const double smooth = std::abs(total(3, Normals::smooth) / exact - 1);
  std::printf("sum of cell echoes off by %.3f %% with facets, %.3f %% smooth\n", 100 * facet,
              100 * smooth);
  EXPECT_LT(smooth, 0.01);
  EXPECT_LT(smooth, facet);
  EXPECT_LT(std::abs(total(6, Normals::facet) / exact - 1), 0.001);
}

}  // namespace
}  // namespace echocine
