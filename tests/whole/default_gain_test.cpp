// A scene that says nothing of gain shows a heart's blood dark and its muscle mid-grey.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "frame/simulator.h"
#include "scene/white_rule.h"
#include "support/paths.h"
#include "support/patient_scene.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

// Median greys of 0 to 255 over a beat's end-diastole and mid-systole, in beam space.
struct Medians {
  double blood = 0, muscle = 0;
};

double medianOf(std::vector<float> greys) {
  EXPECT_GT(greys.size(), 1000u);
  if (greys.empty()) return -1;
  const auto middle = greys.begin() + static_cast<std::ptrdiff_t>(greys.size() / 2);
  std::nth_element(greys.begin(), middle, greys.end());
  return 255 * static_cast<double>(*middle);
}

Medians mediansOf(Scene scene) {
  EXPECT_FALSE(scene.signal.reference_intensity);
  EXPECT_EQ(scene.signal.reference_percentile, kWhiteByMuscle);
  scene.acquisition.frame_rate_hz = 4 * scene.acquisition.heart_rate_hz;
  scene.acquisition.beats = 1;
  scene.probe.lines = 64;
  scene.probe.samples = 256;
  scene.output.channels = {Channel::medium};
  const std::vector<char> muscle = muscleMedia(scene);
  std::vector<float> of_blood, of_muscle;
  const Simulator simulator(scene);
  for (const int i : {0, 1}) {
    const Frame frame = simulator.frame(i / scene.acquisition.frame_rate_hz);
    for (std::size_t at = 0; at < frame.medium.size(); ++at) {
      if (frame.medium[at] >= muscle.size()) continue;
      if (muscle[frame.medium[at]]) of_muscle.push_back(frame.greys.values[at]);
      if (scene.media[frame.medium[at]].name == "blood") of_blood.push_back(frame.greys.values[at]);
    }
  }
  return {medianOf(of_blood), medianOf(of_muscle)};
}

void expectReadable(const Scene& scene) {
  const Medians greys = mediansOf(scene);
  std::printf("  blood %.0f, muscle %.0f\n", greys.blood, greys.muscle);
  EXPECT_LT(greys.blood, 30);
  EXPECT_GT(greys.muscle, 80);
  EXPECT_LT(greys.muscle, 160);
}

TEST(DefaultGain, ShowsTheShippedHeart) {
  const fs::path file = fs::path(kSourceDir) / "examples/beating_heart/scene.toml";
  std::string text = bytesOf(file);
  const std::size_t signal = text.find("[signal]");
  text.erase(signal, text.find("\n\n", signal) - signal);
  expectReadable(parseScene(text, file));
}

TEST(DefaultGain, ShowsThePatient) {
  if (!fs::exists(patientMeshes())) GTEST_SKIP() << "needs " << patientMeshes();
  expectReadable(parsed(patientScene()));
}

struct Part {
  const char *name, *file, *medium;
};

// Closed surfaces of a unit cube, made as large as a heart in a folder of their own; the probe 3 cm
// beyond the end of the left ventricle that is farthest from the left atrium, the right ventricle
// on its left.
SceneText staticHeart(const fs::path& folder, const std::vector<Part>& parts, double size_mm,
                      const TempFolder& scaled) {
  SceneText text;
  std::map<std::string, std::vector<Vec3d>> points;
  int priority = 0;
  for (const Part& part : parts) {
    Sha256 digest;
    const TriangleMesh unit = readMesh(folder / part.file, digest);
    Mesh mesh;
    for (const Vec3d& p : unit.positions) mesh.points.push_back(size_mm * p);
    mesh.triangles = unit.triangles;
    writeObj(mesh, scaled / part.file);
    points[part.name] = mesh.points;
    text.addStructure(part.name, part.medium, '"' + (scaled / part.file).string() + '"',
                      ++priority);
  }
  const Vec3d left = centroid(points.at("lv"));
  const Vec3d axis = normalised(centroid(points.at("la")) - left),
              aside = left - centroid(points.at("rv"));
  const auto along = [&](Vec3d p) { return dot(p - left, axis); };
  double tip = 0;
  for (const Vec3d& p : points.at("lv")) tip = std::min(tip, along(p));
  text.probe["apex"] = vectorText(left + (tip - 30) * axis);
  text.probe["axis"] = vectorText(axis);
  text.probe["lateral"] = vectorText(normalised(aside - dot(aside, axis) * axis));
  text.probe["depth_mm"] = "160";
  text.probe["sector_deg"] = "80";
  text.motion = {{"mesh_unit", "\"mm\""}};
  return text;
}

TEST(DefaultGain, ShowsTheWholeHeart) {
  const fs::path folder = fs::path(kSharedDir) / "real/statics/heartdeform_whole_heart";
  if (!fs::exists(folder)) GTEST_SKIP() << "needs " << folder;
  const TempFolder scaled;
  expectReadable(parsed(staticHeart(folder,
                                    {{"lv_wall", "region_1.obj", "myocardium"},
                                     {"la", "region_2.obj", "blood"},
                                     {"lv", "region_3.obj", "blood"},
                                     {"ra", "region_4.obj", "blood"},
                                     {"rv", "region_5.obj", "blood"}},
                                    180, scaled)));
}

// Chambers alone, in what lies around them.
TEST(DefaultGain, ShowsFourChambers) {
  const fs::path folder = fs::path(kSharedDir) / "real/statics/ghdheart_4ch";
  if (!fs::exists(folder)) GTEST_SKIP() << "needs " << folder;
  const TempFolder scaled;
  expectReadable(parsed(staticHeart(folder,
                                    {{"lv", "LV.obj", "blood"},
                                     {"la", "LA.obj", "blood"},
                                     {"rv", "RV.obj", "blood"},
                                     {"ra", "RA.obj", "blood"}},
                                    85, scaled)));
}

}  // namespace
}  // namespace echocine
