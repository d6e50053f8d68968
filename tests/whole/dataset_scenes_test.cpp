// A dataset of the user's own scenes: their hearts, imaged as the spec draws it.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

constexpr const char* kSpec = R"(scenes = ["small/scene.toml", "large/scene.toml"]
hearts = 4
views = ["a4c"]
layouts = ["echonet", "native"]
picture_px = 112
[split]
train = 50
test = 50
[offset]
tilt_deg = { uniform = [-2, 2] }
apex_miss_mm = { uniform = [-2, 2] }
[scene.probe]
lines = 48
samples = 128
depth_mm = { choice = [150, 160] }
[scene.acquisition]
frame_rate_hz = 10
[scene.signal]
gain_db = { uniform = [-3, 3] }
)";

class DatasetScenes : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    place = std::make_unique<TempFolder>();
    for (const auto& [name, dials] :
         {std::pair("small", "--edv 90"), std::pair("large", "--edv 140")}) {
      const Outcome made = runShell(std::string("%B heart --look paper --keyframes 8 --quiet ") +
                                    dials + " -o '" + (*place / name).string() + "'");
      ASSERT_EQ(made.code, 0) << made.err;
    }
  }
  static void TearDownTestSuite() { place.reset(); }

  static Outcome make(const std::string& text, const std::string& name) {
    const fs::path spec = place->write("spec.toml", text);
    return runShell("%B dataset '" + spec.string() + "' -o '" + (*place / name).string() +
                    "' --quiet");
  }
  static void expectRefused(const std::string& text, const std::vector<std::string>& words) {
    const Outcome outcome = make(text, "refused");
    EXPECT_EQ(outcome.code, 2) << text;
    EXPECT_EQ(linesOf(outcome.err).size(), 1u) << outcome.err;
    for (const std::string& word : words)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " in " << outcome.err;
    EXPECT_FALSE(fs::exists(*place / "refused"));
  }
  static std::string with(const std::string& from, const std::string& to) {
    std::string text = kSpec;
    return text.replace(text.find(from), from.size(), to);
  }

  inline static std::unique_ptr<TempFolder> place;
};

using Row = std::map<std::string, std::string>;

std::vector<Row> rowsOf(const fs::path& file) {
  const auto fields = [](const std::string& line) {
    std::vector<std::string> all;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) all.push_back(field);
    return all;
  };
  const std::vector<std::string> lines = linesOf(bytesOf(file));
  const std::vector<std::string> head = fields(lines.front());
  std::vector<Row> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::vector<std::string> cells = fields(lines[i]);
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (c == 0) rows.emplace_back();
      rows.back()[head[c]] = cells[c];
    }
  }
  return rows;
}

TEST_F(DatasetScenes, TakeTurnsAndEachHasItsOwnSplit) {
  const Outcome made = make(kSpec, "made");
  ASSERT_EQ(made.code, 0) << made.err;
  const std::vector<Row> rows = rowsOf(*place / "made/loops.csv");
  ASSERT_EQ(rows.size(), 4u);
  std::set<std::string> gains;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    EXPECT_EQ(row.at("population"), i % 2 == 0 ? "small/scene.toml" : "large/scene.toml");
    EXPECT_EQ(row.at("split"), i % 2 == 0 ? "train" : "test");
    EXPECT_NEAR(std::stod(row.at("edv_ml")), i % 2 == 0 ? 90 : 140, 2);
    EXPECT_GT(std::stod(row.at("edv_single_plane_ml")), 0.7 * std::stod(row.at("edv_ml")));
    EXPECT_NEAR(std::stod(row.at("edv_biplane_ml")) / std::stod(row.at("edv_ml")), 1, 0.15);
    gains.insert(row.at("scene.signal.gain_db"));
  }
  EXPECT_EQ(gains.size(), 4u);
  EXPECT_EQ(linesOf(bytesOf(*place / "made/echonet/VolumeTracings.csv")).size(), 1 + 4 * 2 * 21u);
  // The same again changes nothing.
  const std::string table = bytesOf(*place / "made/loops.csv");
  ASSERT_EQ(make(kSpec, "made").code, 0);
  EXPECT_EQ(bytesOf(*place / "made/loops.csv"), table);
}

TEST_F(DatasetScenes, TheFolderKnowsWhereItsScenesAre) {
  const std::string text = with("hearts = 4", "hearts = 2");
  ASSERT_EQ(make(text, "known").code, 0);
  const std::string folder = "'" + (*place / "known").string() + "'";
  const Outcome status = runShell("cd / && %B dataset --status " + folder);
  EXPECT_EQ(status.code, 0) << status.err;
  EXPECT_NE(status.out.find("spec: 2 of 2 hearts finished, 0 failed, 0 missing; merged"),
            std::string::npos)
      << status.out;
  const std::string card = bytesOf(*place / "known/README.md");
  const Outcome merged = runShell("cd / && %B dataset -o " + folder + " --merge --quiet");
  EXPECT_EQ(merged.code, 0) << merged.err;
  EXPECT_EQ(bytesOf(*place / "known/README.md"), card);
  const Outcome same = runShell("cd / && %B dataset --diff " + folder + " '" +
                                (*place / "spec.toml").string() + "'");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_EQ(same.out, "");
  const std::string mesh = bytesOf(*place / "small/scene.toml");
  fs::remove(*place / "small/scene.toml");
  const Outcome moved = runShell("%B dataset --status " + folder);
  place->write("small/scene.toml", mesh);
  EXPECT_EQ(moved.code, 2);
  EXPECT_NE(moved.err.find("small/scene.toml"), std::string::npos) << moved.err;
}

// All draws of a scene are in the same fold.
TEST_F(DatasetScenes, FoldsKeepScenesTogether) {
  std::string text = with("[\"echonet\", \"native\"]", "[\"nnunet\"]");
  text.replace(text.find("train = 50\ntest = 50"), 20, "train = 100\ntest = 0");
  ASSERT_EQ(make(text, "folds").code, 0);
  const auto folds = nlohmann::json::parse(
      bytesOf(*place / "folds/nnunet/nnUNet_preprocessed/Dataset501_EchoCine/splits_final.json"));
  ASSERT_EQ(folds.size(), 2u);
  for (const auto& fold : folds) {
    std::set<int> scenes;
    for (const auto& name : fold["val"])
      scenes.insert(std::stoi(name.get<std::string>().substr(2, 6)) % 2);
    EXPECT_EQ(fold["val"].size(), 4u);
    EXPECT_EQ(scenes.size(), 1u);
  }
}

TEST_F(DatasetScenes, OtherMeshesAreAnotherDataset) {
  ASSERT_EQ(make(with("hearts = 4", "hearts = 2"), "moved").code, 0);
  const fs::path mesh = *place / "small/lv_cavity_03.obj";
  const std::string bytes = bytesOf(mesh);
  std::string other = bytes;
  const std::size_t digit = other.find_first_of("0123456789", other.find("\nv ")) + 3;
  other[digit] = other[digit] == '5' ? '6' : '5';
  place->write("small/lv_cavity_03.obj", other);
  const Outcome again = make(with("hearts = 4", "hearts = 2"), "moved");
  place->write("small/lv_cavity_03.obj", bytes);
  EXPECT_EQ(again.code, 2) << again.err;
  EXPECT_NE(again.err.find("another spec"), std::string::npos) << again.err;
}

TEST_F(DatasetScenes, WhatTheyCannotBeIsRefused) {
  expectRefused(std::string(kSpec) + "[heart]\nef = 0.5\n", {"heart", "parametric", "scenes"});
  expectRefused(std::string(kSpec) + "[populations]\nhealthy = 1\n", {"populations", "scenes"});
  expectRefused(with("small/scene.toml", "none/scene.toml"),
                {"spec.toml:1", "scenes", "none/scene.toml"});
  expectRefused(with("small/scene.toml", "large/scene.toml"),
                {"scenes", "large/scene.toml", "twice"});
  expectRefused(with("hearts = 4", "hearts = 1"), {"spec.toml:2", "hearts", "2 to"});
  expectRefused(with("lines = 48", "view = \"a2c\""), {"scene.probe.view", "views"});
  expectRefused(with("uniform = [-3, 3]", "uniform = [-3, 150]"),
                {"scene.signal.gain_db", "149.9"});
  std::string text = bytesOf(*place / "small/scene.toml");
  for (std::size_t at = 0; (at = text.find("lv_cavity\"", at)) != std::string::npos; at += 5)
    text.replace(at, 10, "left\"");
  place->write("small/other.toml", text);
  expectRefused(with("small/scene.toml", "small/other.toml"),
                {"scenes", "small/other.toml", "lv_cavity"});
}

}  // namespace
}  // namespace echocine
