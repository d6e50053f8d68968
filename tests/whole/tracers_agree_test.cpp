// The plane slice and the hierarchy trace the same image, also where vertices and edges lie exactly
// on the imaging plane and on scan lines.

#include <gtest/gtest.h>

#include "motion/surfaces/mesh_motion.h"
#include "scene/scene_reader.h"
#include "support/paths.h"
#include "support/scene_text.h"
#include "support/shipped_heart.h"
#include "support/temp_folder.h"
#include "trace/trace_frame.h"

namespace echocine {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = support::kSharedDir;

// Puts every vertex near the plane, the middle line and the plane z = 80 mm exactly there.
void snap(SurfaceFrame& frame, float within_m) {
  for (auto& positions : frame.positions_m)
    for (Vec3f& p : positions) {
      if (std::abs(p.y) < within_m) p.y = 0;
      if (std::abs(p.x) < within_m) p.x = 0;
      if (std::abs(p.z - 0.08f) < within_m) p.z = 0.08f;
    }
}

void expectSameImage(const Scene& scene, const std::vector<SurfaceTopology>& surfaces,
                     const SurfaceFrame& frame) {
  PlaneSlice slice(surfaces, scene.probe);
  FrameGeometry geometry(surfaces);
  slice.update(frame);
  geometry.update(frame);
  EffectPlan plan = planEffects(scene);
  plan.refraction = false;
  const TraceSettings settings(scene, plan);
  const PlaneRequest request = planeRequest(scene, plan);
  PolarFrame sliced, traced;
  const WorkCounts by_slice = traceFrame(slice, scene.probe, settings, request, sliced);
  const WorkCounts by_rays = traceFrame(geometry, scene.probe, settings, request, traced);
  EXPECT_EQ(by_slice.crossings, by_rays.crossings);
  EXPECT_GT(by_slice.crossings, static_cast<std::uint64_t>(scene.probe.lines));
  const std::vector<float>&a = sliced.planes.at(Channel::y), &b = traced.planes.at(Channel::y);
  std::size_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different += std::abs(a[i] - b[i]) > 1e-5f * std::abs(b[i]) ? 1 : 0;
  EXPECT_EQ(different, 0u) << "of " << a.size() << " samples";
}

void expectAgreementOf(Scene scene) {
  scene.probe.lines = 255;  // odd: the middle line is exactly depthwards
  scene.probe.samples = 512;
  const MeshMotion motion(scene);
  SurfaceFrame frame;
  for (const double phase : {0.0, 0.31, 0.55}) {
    motion.frameAt(phase, frame);
    expectSameImage(scene, motion.surfaces(), frame);
  }
  // Snapped frames are none of this motion: any triangle may be at the plane.
  std::vector<SurfaceTopology> surfaces = motion.surfaces();
  for (SurfaceTopology& surface : surfaces) surface.near_plane.reset();
  for (const float within_m : {1e-4f, 1e-3f, 5e-3f}) {
    SurfaceFrame snapped = frame;
    snap(snapped, within_m);
    expectSameImage(scene, surfaces, snapped);
  }
}

// Facet or smooth normals: the frame has them or not.
void expectAgreement(Scene scene) {
  for (const Normals normals : {Normals::facet, Normals::smooth}) {
    scene.accuracy.normals = normals;
    expectAgreementOf(scene);
  }
}

TEST(TracersAgree, OnTheShippedHeart) {
  expectAgreement(support::shippedPaperHeart());
}

// Meshes that nobody made for this program.
TEST(TracersAgree, OnTheRealPatient) {
  const fs::path meshes = kShared / "real/meshes/bivme_patient1_25f";
  if (!fs::exists(meshes)) GTEST_SKIP() << "no real patient at " << meshes;
  support::SceneText text;
  const auto pattern = [&](const char* name) { return "\"" + (meshes / name).string() + "\""; };
  text.motion["mesh_unit"] = "\"mm\"";
  text.setProbe("apex", "[50, -38, -112]");
  text.setProbe("axis", "[-38.7, 55.2, 66.8]");
  text.setProbe("lateral", "[44, 21, 25]");
  text.setProbe("depth_mm", "180");
  text.addStructure("lv", "blood", pattern("lv_endo_closed_*.obj"), 30);
  text.addStructure("rv", "blood", pattern("rv_endo_closed_*.obj"), 20);
  text.addStructure("epi", "myocardium", pattern("epi_*.obj"), 10,
                    "lids = [" + pattern("mitral_valve_*.obj") + ", " +
                        pattern("aortic_valve_*.obj") + ", " + pattern("tricuspid_valve_*.obj") +
                        ", " + pattern("pulmonary_valve_*.obj") + "]\n");
  expectAgreement(support::parsed(text));
}

TEST(TracersAgree, OnAWholeHeartOfSevenParts) {
  const fs::path meshes = kShared / "real/statics/heartdeform_whole_heart";
  if (!fs::exists(meshes)) GTEST_SKIP() << "no whole heart at " << meshes;
  support::SceneText text;
  text.motion["mesh_unit"] = "\"cm\"";  // a unit cube, taken as 10 cm by the copies below
  support::TempFolder folder;
  for (int region = 1; region <= 7; ++region) {
    const std::string name = "region_" + std::to_string(region) + ".obj";
    std::ifstream in(meshes / name);
    std::ofstream out(folder.path() / name);
    for (std::string kind, line; std::getline(in, line);) {
      std::istringstream words(line);
      double x = 0, y = 0, z = 0;
      if (words >> kind && kind == "v" && words >> x >> y >> z)
        out << "v " << 10 * x << ' ' << 10 * y << ' ' << 10 * z << '\n';
      else
        out << line << '\n';
    }
    text.addStructure("region_" + std::to_string(region), region == 1 ? "myocardium" : "blood",
                      "\"" + (folder.path() / name).string() + "\"", region);
  }
  text.setProbe("apex", "[5, 5, -3]");
  text.setProbe("depth_mm", "160");
  expectAgreement(support::parsed(text));
}

}  // namespace
}  // namespace echocine
