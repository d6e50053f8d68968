// Strain does not depend on how finely surfaces are meshed. Oracle: an integral along the meridian
// of an ellipsoid.

#include <gtest/gtest.h>

#include <cmath>

#include "support/scene_text.h"
#include "truth/frame_truth.h"

namespace echocine::mesh_density_law {
namespace {

using support::Mesh;

// An ellipsoid of revolution about z, rings crowded at its lower end by `crowd`: 1 none. Polar
// angles run from 0 at the upper end.
Mesh ellipsoid(double across, double along, int rings, int segments, double crowd) {
  Mesh m = support::uvSphere(rings, segments, 1);
  for (Vec3d& p : m.points) {
    const double polar = std::atan2(std::hypot(p.x, p.y), p.z), turn = std::atan2(p.y, p.x);
    const double moved = std::numbers::pi * std::pow(polar / std::numbers::pi, 1 / crowd);
    p = {across * std::sin(moved) * std::cos(turn), across * std::sin(moved) * std::sin(turn),
         along * std::cos(moved)};
  }
  return m;
}

std::shared_ptr<const TriangleMesh> shared(const Mesh& mesh) {
  return std::make_shared<TriangleMesh>(TriangleMesh{mesh.points, mesh.triangles, {}, {}});
}

// mm; the base is at z = +along, the apex looks to the probe.
constexpr double kAcross = 25, kAlong = 45, kOuterAcross = 35, kOuterAlong = 55, kDepth = 90;

// The apex shortens more than the base: z from the base's plane.
Vec3d contracted(Vec3d p) {
  const double from_base = kAlong - p.z, length = 2 * kAlong;
  return {p.x, p.y, kAlong - from_base * (1 - 0.2 * from_base / length)};
}

// The same along the meridian through x, by its own quadrature.
double closedForm() {
  struct Place {
    double x, z, nx, nz;
  };
  const auto middleAt = [](double t) {  // polar angle from the base
    const double x = kAcross * std::sin(t), z = kAlong * std::cos(t);
    double nx = x / (kAcross * kAcross), nz = z / (kAlong * kAlong);
    const double size = std::hypot(nx, nz);
    nx /= size;
    nz /= size;
    // Where the normal leaves the outer ellipsoid.
    const double a = kOuterAcross * kOuterAcross, b = kOuterAlong * kOuterAlong;
    const double A = nx * nx / a + nz * nz / b, B = x * nx / a + z * nz / b,
                 C = x * x / a + z * z / b - 1;
    const double half = 0.5 * (-B + std::sqrt(B * B - A * C)) / A;
    return Place{x + half * nx, z + half * nz, nx, nz};
  };
  double strained = 0, whole = 0;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double t = std::numbers::pi * (i + 0.5) / kSteps, h = 0.5 * std::numbers::pi / kSteps;
    const Place here = middleAt(t), before = middleAt(t - h), after = middleAt(t + h);
    // At the base no longitudinal direction is taken where the normal is nearly along the axis.
    if (here.nz > 0 && here.nx < 0.2) continue;
    const double ds = std::hypot(after.x - before.x, after.z - before.z);
    const double slope = 1 - 0.4 * (kAlong - here.z) / (2 * kAlong);  // of z
    strained += ds * (std::hypot(here.nz, slope * here.nx) - 1);
    whole += ds;
  }
  return strained / whole;
}

FunctionFrame contractedFunction(int rings, int segments, double crowd) {
  support::SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}, {"interpolation", "\"linear\""}};
  text.probe["depth_mm"] = "170";
  text.addStructure("wall", "myocardium", "[\"wall_0\", \"wall_1\"]", 1, "role = \"lv_wall\"");
  text.addStructure("cavity", "blood", "[\"cavity_0\", \"cavity_1\"]", 2, "role = \"lv_cavity\"");
  text.addStructure("atrium", "blood", "\"atrium\"", 1, "role = \"la\"");
  const Mesh cavity = ellipsoid(kAcross, kAlong, rings, segments, crowd),
             wall = ellipsoid(kOuterAcross, kOuterAlong, rings, segments, crowd);
  const auto inProbe = [](Mesh mesh, bool moved) {
    for (Vec3d& p : mesh.points) p = (moved ? contracted(p) : p) + Vec3d{0, 0, kDepth};
    return shared(mesh);
  };
  const NamedMeshes meshes{
      {"wall_0", inProbe(wall, false)},
      {"wall_1", inProbe(wall, true)},
      {"cavity_0", inProbe(cavity, false)},
      {"cavity_1", inProbe(cavity, true)},
      {"atrium", shared(support::icosphere(4, 2.5).moved({0, 0, kDepth + kAlong + 2.5}))}};
  Scene scene = parseScene(text.text(), "in memory", meshes);
  scene.truth.function = true;
  const MeshMotion motion(scene);
  return *TruthMaker(scene, motion, {}, 0).at({0.5, 0.5, 0.5, 1}).function;
}

TEST(MeshDensityLaw, StrainIsThatOfTheMeridians) {
  const double exact = closedForm();
  struct Way {
    int rings, segments;
    double crowd;
  };
  for (const Way& way : {Way{80, 48, 1}, Way{32, 32, 1}, Way{48, 48, 1.4}, Way{64, 40, 0.6}}) {
    const FunctionFrame f = contractedFunction(way.rings, way.segments, way.crowd);
    std::printf("%d rings, crowded by %.1f: GLS %.4f, view %.4f; closed form %.4f\n", way.rings,
                way.crowd, f.global_longitudinal_strain, f.view_longitudinal_strain, exact);
    EXPECT_NEAR(f.global_longitudinal_strain, exact, 1e-3) << way.crowd;
    EXPECT_NEAR(f.view_longitudinal_strain, exact, 1e-3) << way.crowd;
  }
}

}  // namespace
}  // namespace echocine::mesh_density_law
