// The catalogue of recordings beside an archive's stores.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "archive/echoxflow.h"
#include "core/error.h"
#include "support/beam_loops.h"
#include "support/loop_scene.h"
#include "support/run_files.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

// A catalogue that another program wrote may have other types. Its rows stay; a damaged one is
// refused before the recording is replaced.
TEST(BeamCatalogue, ADamagedCatalogueLeavesTheRecording) {
  const BeamLoop loop = smallBeamLoop();
  const TempFolder folder;
  const fs::path root = folder / "root", zarr = root / "exam/loop.zarr";
  writeEchoXFlow(loop, root, "exam", "loop");
  EXPECT_THROW(writeEchoXFlow(loop, root, "", "loop"), SceneError);
  EXPECT_THROW(writeEchoXFlow(loop, root, "exam", ""), SceneError);
  const std::string chunk = bytesOf(zarr / ".zattrs");
  folder.write("root/croissant.json", "[]");
  EXPECT_THROW(writeEchoXFlow(smallBeamLoop(9), root, "exam", "loop"), SceneError);
  EXPECT_EQ(bytesOf(zarr / ".zattrs"), chunk);
  folder.write(
      "root/croissant.json",
      R"({"recordSet": [{"@id": 3}, {"@id": "recordings", "data": [{"recordings/zarr_path": 7}]}]})");
  writeEchoXFlow(loop, root, "exam", "loop");
  const auto catalogue = nlohmann::json::parse(bytesOf(root / "croissant.json"));
  EXPECT_EQ(catalogue.at("recordSet").at(1).at("data").size(), 2u);
}

// A run that is killed while it replaces a recording leaves the earlier one aside.
TEST(BeamCatalogue, ARecordingIsReplacedWholly) {
  const TempFolder folder;
  const fs::path root = folder / "root", exam = root / "exam", zarr = exam / "loop.zarr";
  writeEchoXFlow(smallBeamLoop(), root, "exam", "loop");
  const std::string first = bytesOf(zarr / ".zattrs");
  fs::rename(zarr, exam / ".loop.zarr.earlier");
  BeamLoop other = smallBeamLoop(9);
  other.scene.probe.max_depth_m = 0.1;
  writeEchoXFlow(other, root, "exam", "loop");
  EXPECT_NE(bytesOf(zarr / ".zattrs"), first);
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(exam))
    left.push_back(entry.path().filename().string());
  EXPECT_EQ(left, std::vector<std::string>{"loop.zarr"});
}

// Wrong names and places end the command before a loop is rendered.
TEST(BeamCatalogue, NamesOfZeaAreCheckedBeforeTheRender) {
  const TempFolder folder;
  writeBall(folder, ballScene(4));
  const std::string scene = " '" + (folder / "scene.toml").string() + "'",
                    out = " -o '" + (folder / "loop.hdf5").string() + "'";
  const auto refused = [&](const std::string& options, int code, const char* words) {
    const Outcome o = runShell("%B archive" + scene + options);
    EXPECT_EQ(o.code, code) << options << o.err;
    EXPECT_NE(o.err.find(words), std::string::npos) << o.err;
    EXPECT_EQ(o.err.find("rendering"), std::string::npos) << o.err;
    EXPECT_FALSE(fs::is_regular_file(folder / "loop.hdf5"));
  };
  refused(out + " --layout zea --recording a", 2, "--recording");
  refused(out + " --layout zea --exam ' '", 2, "--exam");
  refused(" -o '" + folder.path().string() + "' --layout zea", 1, "is a folder");
}

// Warnings of a scene and of its plan are those of a render.
TEST(BeamCatalogue, AnArchiveWarnsAsARender) {
  const TempFolder folder;
  SceneText text = ballScene(4);
  text.structures.replace(text.structures.find("name = \"wall\""), 13,
                          "name = \"wall\"\nrole = \"lv_wall\"");
  text.addStructure("beside", "blood", "\"cavity_0.obj\"", 3, "role = \"rv_cavity\"");
  writeBall(folder, text);
  const std::string scene = " '" + (folder / "scene.toml").string() + "'";
  const auto warnings = [&](const std::string& command) {
    const Outcome o = runShell("%B " + command);
    EXPECT_EQ(o.code, 0) << o.err;
    std::vector<std::string> lines;
    for (const std::string& line : linesOf(o.err))
      if (line.find("warning") != std::string::npos) lines.push_back(line);
    return lines;
  };
  const auto rendered = warnings("render" + scene + " -o '" + (folder / "loop").string() + "'");
  EXPECT_FALSE(rendered.empty());
  EXPECT_EQ(warnings("archive" + scene + " --layout zea -o '" + (folder / "a.hdf5").string() + "'"),
            rendered);
  EXPECT_EQ(warnings("mmode" + scene + " -o '" + (folder / "m").string() + "'"), rendered);
  EXPECT_EQ(warnings("doppler" + scene + " -o '" + (folder / "d").string() + "'"), rendered);
}

}  // namespace
}  // namespace echocine
