// volumes.csv against the manifest and truth/function.json of the same run.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "output/volumes_csv.h"
#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;

std::vector<std::vector<std::string>> csvRows(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string>& row = rows.emplace_back();
    std::istringstream fields(line + ",");
    for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
  }
  return rows;
}

TEST(VolumesTable, HasTheManifestsVolumesOfBloodToTheLastDigit) {
  TempFolder folder;
  const auto scene = writeBall(folder, ballScene(6));
  ASSERT_EQ(renderScene(scene, folder / "out", "--frames 1:5").code, 0);
  const auto rows = csvRows(bytesOf(folder / "out/volumes.csv"));
  const auto manifest = nlohmann::json::parse(bytesOf(folder / "out/manifest.json"));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"frame", "time_s", "phase", "beat", "cavity_ml"}));
  double least = 1e9, most = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const auto& frame = manifest.at("frames").at(i - 1);
    ASSERT_EQ(rows[i].size(), 5u);
    EXPECT_EQ(std::stoi(rows[i][0]), frame.at("index").get<int>());
    EXPECT_EQ(std::stod(rows[i][1]), frame.at("time_s").get<double>());
    EXPECT_EQ(std::stod(rows[i][2]), frame.at("phase").get<double>());
    const double volume_ml = std::stod(rows[i][4]);
    EXPECT_EQ(volume_ml, frame.at("volumes_ml").at("cavity").get<double>());
    least = std::min(least, volume_ml), most = std::max(most, volume_ml);
  }
  // A sphere of radius 2.5 cm times 0.85 to 1.15, up to the icosphere's chords.
  EXPECT_GT(most / least, 1.5);
  EXPECT_TRUE(manifest.at("files").contains("volumes.csv"));
}

TEST(VolumesTable, IsAbsentWithoutChambersAndWhereItIsSwitchedOff) {
  TempFolder folder;
  SceneText text = ballScene(3);
  text.output["volumes"] = "false";
  ASSERT_EQ(renderScene(writeBall(folder, text), folder / "off", "--frames :1").code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "off/volumes.csv"));
  SceneText wall = ballScene(3);
  wall.structures.clear();
  wall.addStructure("wall", "myocardium", "\"wall_*.obj\"", 1);
  ASSERT_EQ(renderScene(writeBall(folder, wall), folder / "wall", "--frames :1").code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder / "wall/volumes.csv"));
}

// Strain of a run with functional truth: the manifest's curves, undefined values empty, names
// quoted by RFC 4180.
TEST(VolumesTable, HasStrainQuotedNamesAndEmptyCells) {
  Scene scene;
  Medium blood, muscle;
  blood.blood = true;
  scene.media = {blood, muscle};
  for (const char* name : {"left, \"big\"", "wall", "sheet"}) {
    Structure s;
    s.name = name;
    s.medium = static_cast<MediumId>(s.name == "wall" ? 1 : 0);
    s.membrane = s.name == "sheet";
    scene.structures.push_back(s);
  }
  EXPECT_TRUE(hasChambers(scene));
  Manifest manifest;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  manifest.frames = {{{0, 0, 0, 0}, {{"left, \"big\"", 100.25}, {"wall", 7}}, ""},
                     {{1, 0.1, 0.5, 0}, {{"left, \"big\"", 60}, {"wall", 7}}, ""}};
  manifest.curves = {{"global_longitudinal_strain", {0, -0.125}},
                     {"basal anterior", {nan, -0.25}},
                     {"mid anterior", {}},
                     {"wall_thickness_mm", {9, 10}}};
  EXPECT_EQ(volumesCsv(scene, manifest),
            "frame,time_s,phase,beat,\"left, \"\"big\"\"_ml\",global_longitudinal_strain,"
            "basal_anterior_longitudinal_strain\n"
            "0,0,0,0,100.25,0,\n"
            "1,0.1,0.5,0,60,-0.125,-0.25\n");
  scene.structures.erase(scene.structures.begin());
  EXPECT_FALSE(hasChambers(scene));
}

}  // namespace
}  // namespace echocine
