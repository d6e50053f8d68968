// Labels of whole hearts against a test of every pixel that owes nothing to slices: how often the
// surfaces wind round it, counted over all triangles across the imaging plane from it.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "motion/surfaces/mesh_motion.h"
#include "scene/scan_geometry.h"
#include "scene/scene_reader.h"
#include "support/meshes.h"
#include "support/patient_scene.h"
#include "support/temp_folder.h"
#include "truth/plane_labels.h"

namespace echocine {
namespace {

// 400 x 300 pixels of 0.5 mm; the apex in the middle of the top.
const PictureGrid kGrid{400, 300, 200.37, 2.41, 0.5e-3};
constexpr std::size_t kPixels = 400 * 300;

double twiceArea(Vec3d a, Vec3d b, double x, double z) {
  return (b.x - a.x) * (z - a.z) - (b.z - a.z) * (x - a.x);
}

// Adds a triangle's turn to the pixels that lie beneath it, seen along y.
void addTurns(Vec3d a, Vec3d b, Vec3d c, std::vector<int>& winding) {
  const double area = twiceArea(a, b, c.x, c.z);
  if (area == 0 || std::max({a.y, b.y, c.y}) < 0) return;
  const double px = 1 / kGrid.metres_per_pixel;
  const auto within = [](double v, int count) { return std::clamp(static_cast<int>(v), 0, count); };
  const int left = within(std::min({a.x, b.x, c.x}) * px + kGrid.origin_x_px - 1, kGrid.width),
            right = within(std::max({a.x, b.x, c.x}) * px + kGrid.origin_x_px + 1, kGrid.width),
            top = within(std::min({a.z, b.z, c.z}) * px + kGrid.origin_y_px - 1, kGrid.height),
            foot = within(std::max({a.z, b.z, c.z}) * px + kGrid.origin_y_px + 1, kGrid.height);
  for (int row = top; row < foot; ++row)
    for (int column = left; column < right; ++column) {
      const double x = kGrid.xOf(column), z = kGrid.zOf(row);
      const double wa = twiceArea(b, c, x, z) / area, wb = twiceArea(c, a, x, z) / area,
                   wc = twiceArea(a, b, x, z) / area;
      if (wa < 0 || wb < 0 || wc < 0 || wa * a.y + wb * b.y + wc * c.y < 0) continue;
      winding[static_cast<std::size_t>(row * kGrid.width + column)] += area > 0 ? 1 : -1;
    }
}

std::vector<std::uint16_t> bruteForce(const Scene& scene, const MeshMotion& motion,
                                      const SurfaceFrame& frame) {
  std::vector<std::uint16_t> ids(kPixels, 0);
  std::vector<int> best(kPixels, -1), winding;
  for (const SurfaceTopology& surface : motion.surfaces()) {
    const std::size_t s = index(surface.id);
    if (surface.membrane) continue;
    winding.assign(kPixels, 0);
    for (const Triangle& t : surface.triangles)
      addTurns(toDouble(frame.positions_m[s][t[0]]), toDouble(frame.positions_m[s][t[1]]),
               toDouble(frame.positions_m[s][t[2]]), winding);
    const int priority = scene.structures[s].priority;
    for (std::size_t i = 0; i < kPixels; ++i)
      if (winding[i] != 0 && priority >= best[i]) {
        best[i] = priority;
        ids[i] = static_cast<std::uint16_t>(s + 1);
      }
  }
  for (int row = 0; row < kGrid.height; ++row)
    for (int column = 0; column < kGrid.width; ++column)
      if (!inScanArea(scene.probe, kGrid.xOf(column), kGrid.zOf(row)))
        ids[static_cast<std::size_t>(row * kGrid.width + column)] = 0;
  return ids;
}

// The label in the picture, or one of its neighbours': samples and pixels have other centres.
bool isNear(const PlaneLabels::Ids& ids, double x_m, double z_m, std::uint32_t id) {
  const double px = 1 / kGrid.metres_per_pixel;
  const int column = static_cast<int>(x_m * px + kGrid.origin_x_px),
            row = static_cast<int>(z_m * px + kGrid.origin_y_px);
  for (int r = row - 1; r <= row + 1; ++r)
    for (int c = column - 1; c <= column + 1; ++c)
      if (r < 0 || c < 0 || r >= kGrid.height || c >= kGrid.width ||
          ids[static_cast<std::size_t>(r * kGrid.width + c)] == id)
        return true;
  return false;
}

void expectLabels(Scene scene, double phase) {
  const MeshMotion motion(scene);
  SurfaceFrame frame;
  motion.frameAt(phase, frame);
  PlaneSlice slice(motion.surfaces(), scene.probe);
  slice.update(frame);
  const PlaneLabels labels(scene, kGrid);
  PlaneLabels::Ids ids;
  labels.picture(slice.edges(), ids);
  const std::vector<std::uint16_t> expected = bruteForce(scene, motion, frame);
  std::size_t wrong = 0, inside = 0, beam_wrong = 0;
  for (std::size_t i = 0; i < kPixels; ++i) {
    wrong += ids[i] != expected[i];
    inside += ids[i] != 0;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_GT(inside, 10000u);
  std::vector<std::uint32_t> samples;
  labels.samples(slice.lines(), samples);
  for (int line = 0; line < scene.probe.lines; ++line) {
    const LineGeometry g = lineGeometry(scene.probe, line);
    for (int k = 0; k < scene.probe.samples; ++k) {
      const double path_m = scene.probe.min_depth_m + (k + 0.5) * scene.probe.sampleSpacing();
      const Vec3d p = g.origin + path_m * g.direction;
      beam_wrong +=
          !isNear(ids, p.x, p.z, samples[static_cast<std::size_t>(line * scene.probe.samples + k)]);
    }
  }
  // What is thinner than a pixel may pass between pixels' centres.
  EXPECT_LT(beam_wrong, samples.size() / 1000);
}

TEST(TruthLabelsOfHearts, TheShippedOne) {
  Scene scene =
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
  scene.probe.lines = 65;
  for (const double phase : {0.0, 0.31}) expectLabels(scene, phase);
}

TEST(TruthLabelsOfHearts, APatients) {
  if (!std::filesystem::exists(support::patientMeshes())) GTEST_SKIP() << "no real meshes here";
  const support::TempFolder folder;
  const Scene scene = parseScene(support::patientScene().text(), folder.path() / "scene.toml");
  for (const double phase : {0.0, 0.35}) expectLabels(scene, phase);
}

// Meshes of any unit, put 13 cm wide in the middle of the sector.
void expectLabelsOf(const std::string& set, const std::vector<std::string>& names) {
  const std::filesystem::path meshes =
      std::filesystem::path(support::kSharedDir) / "real/statics" / set;
  if (!std::filesystem::exists(meshes)) GTEST_SKIP() << "no real meshes at " << meshes;
  std::vector<TriangleMesh> read;
  Box box;
  for (const std::string& name : names) {
    Sha256 digest;
    read.push_back(readMesh(meshes / (name + ".obj"), digest));
    for (const Vec3d p : read.back().positions) box.add(p);
  }
  const Vec3d size = box.hi - box.lo, middle = 0.5 * (box.lo + box.hi);
  const double mm = 130 / std::max({size.x, size.y, size.z});
  support::SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}};
  text.probe["depth_mm"] = "160";
  text.probe["lines"] = "65";
  text.probe["samples"] = "400";
  NamedMeshes named;
  int priority = 1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (Vec3d& p : read[i].positions) p = mm * (p - middle) + Vec3d{0, 0, 80};
    named[names[i]] = std::make_shared<TriangleMesh>(read[i]);
    text.addStructure(names[i], i == 0 ? "myocardium" : "blood", "\"" + names[i] + "\"",
                      priority++);
  }
  expectLabels(parseScene(text.text(), "in memory", named), 0);
}

TEST(TruthLabelsOfHearts, AWholeHeartOfSevenParts) {
  expectLabelsOf("heartdeform_whole_heart", {"region_1", "region_2", "region_3", "region_4",
                                             "region_5", "region_6", "region_7"});
}

TEST(TruthLabelsOfHearts, FourChambers) {
  expectLabelsOf("ghdheart_4ch", {"LV", "RV", "LA", "RA"});
}

}  // namespace
}  // namespace echocine
