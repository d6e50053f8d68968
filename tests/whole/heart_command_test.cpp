// echocine heart: what it writes, what it refuses, and that nothing half done stays behind.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "support/recorded_heart.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

class HeartCommand : public testing::Test {
 protected:
  // The command with output into `name`, few keyframes unless told otherwise.
  Outcome heart(const std::string& options, const std::string& name = "heart") const {
    return runShell("%B heart -o '" + (folder / name).string() + "' --quiet " + options);
  }
  // Exit code 2, one line that holds all words, and no folder.
  void expectRefused(const std::string& options, const std::vector<std::string>& words) const {
    const Outcome outcome = heart(options);
    EXPECT_EQ(outcome.code, 2) << options << '\n' << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const std::string& word : words)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " in " << outcome.err;
    EXPECT_TRUE(fs::is_empty(folder.path())) << options;
  }
  TempFolder folder;
};

// Every dial by the function that the command calls, some by the command itself.
TEST_F(HeartCommand, DialsBeyondTheirRangeAreRefused) {
  for (const heart::Dial& dial : heart::dials())
    for (const double value :
         {1.01 * dial.low - 0.01 * dial.high - 1e-3, 1.01 * dial.high - 0.01 * dial.low + 1e-3}) {
      heart::Parameters parameters;
      dial.set(parameters, value);
      try {
        writeHeart({.parameters = parameters}, folder / "heart");
        ADD_FAILURE() << dial.key << ' ' << value << " is accepted";
      } catch (const SceneError& error) {
        const std::string start = fmt::format("heart: {} is {:g}; accepted are {:g} to {:g}",
                                              dial.key, value, dial.low, dial.high);
        EXPECT_EQ(std::string(error.what()).substr(0, start.size()), start);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
    }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  expectRefused("--ef 0.86", {"ef is 0.86", "0.05 to 0.85"});
  expectRefused("--hr 29.9", {"hr is 29.9", "30 to 200 bpm"});
  expectRefused("--twist=-10.1", {"twist is -10.1"});
  expectRefused("--edv nan", {"edv"});
  expectRefused("--edv big", {"edv"});
}

TEST_F(HeartCommand, DialsThatExcludeEachOtherAreRefused) {
  expectRefused("--ef 0.06 --mapse 20 --keyframes 4", {"ef", "mapse", "accepted"});
  expectRefused("--edv 150 --ef 0.6 --rv-edv 100", {"rv-edv", "edv", "90"});
}

TEST_F(HeartCommand, UnusableSegmentsViewsAndCountsAreRefused) {
  for (const char* text : {"7", "7:", "0:1", "18:1", "7.5:1", "7:x", "7:1:20:3", "''"})
    expectRefused(std::string("--segment ") + text, {});
  expectRefused("--segment 7:1.6", {"segment 7", "-0.5 to 1.5"});
  expectRefused("--segment 7:-0.6", {"segment 7"});
  expectRefused("--segment 7:1:201", {"segment 7", "0 to 200"});
  expectRefused("--segment 7:1:-1", {"segment 7"});
  expectRefused("--view a5c", {"a5c", "a4c", "subcostal"});
  expectRefused("--keyframes 3", {"keyframes"});
  expectRefused("--keyframes 101", {"keyframes"});
  expectRefused("--nonsense 1", {});
}

TEST_F(HeartCommand, AFolderThatIsNotEmptyStaysAsItIs) {
  fs::create_directory(folder / "full");
  std::ofstream(folder / "full/mine.txt") << "mine";
  const Outcome outcome = heart("--keyframes 4", "full");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("is not empty"), std::string::npos) << outcome.err;
  EXPECT_EQ(bytesOf(folder / "full/mine.txt"), "mine");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST_F(HeartCommand, AFolderThatCannotBeMadeIsAFailedJob) {
  folder.write("file", "");
  std::vector<std::string> places{(folder / "file/heart").string(), "/proc/echocine_heart"};
  if (::geteuid() != 0) {  // root may write anywhere
    fs::create_directory(folder / "closed");
    fs::permissions(folder / "closed", fs::perms::owner_read | fs::perms::owner_exec);
    places.push_back((folder / "closed/heart").string());
  }
  for (const std::string& place : places) {
    const Outcome outcome = runShell("%B heart --quiet --keyframes 4 -o " + place);
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(place));
  }
}

// The disk is as good as full: no file may hold more than 8 KiB.
TEST_F(HeartCommand, AWriteThatFailsLeavesNothing) {
  const Outcome outcome =
      runShell("trap '' XFSZ; ulimit -f 8; %B heart --quiet --keyframes 4 -o '" +
               (folder / "heart").string() + "'");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST_F(HeartCommand, AKilledRunLeavesNoFolderOfTheWantedName) {
  const Outcome outcome =
      runShell("timeout -s KILL 0.15 %B heart --keyframes 100 --threads 1 -o '" +
               (folder / "heart").string() + "'");
  EXPECT_EQ(outcome.code, 137);  // killed before its end
  EXPECT_FALSE(fs::exists(folder / "heart"));
}

TEST_F(HeartCommand, TheSameOptionsGiveTheSameBytesForAnyThreads) {
  const std::string options = "--keyframes 4 --view plax --ef 0.45 --segment 7:0:40 --threads ";
  ASSERT_EQ(heart(options + "1", "one").code, 0);
  ASSERT_EQ(heart(options + "2", "two").code, 0);
  const Outcome difference =
      runShell("diff -r '" + (folder / "one").string() + "' '" + (folder / "two").string() + "'");
  EXPECT_EQ(difference.code, 0) << difference.out;
  EXPECT_GT(std::distance(fs::directory_iterator(folder / "one"), {}), 100);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
}

// One frame of a few lines; the meshes as they are.
TEST_F(HeartCommand, WhatItWritesRendersWithoutAWarning) {
  const Outcome made = runShell("%B heart --keyframes 8 -o '" + (folder / "heart").string() + "'");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.err, "");
  EXPECT_NE(made.out.find("8 keyframes in "), std::string::npos) << made.out;
  EXPECT_NE(made.out.find("echocine render "), std::string::npos) << made.out;

  const fs::path scene = folder / "heart/scene.toml";
  std::string text = bytesOf(scene);
  const auto put = [&text](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  put("lines = 256", "lines = 24");
  put("samples = 1024", "samples = 96");
  put("frame_rate_hz = 50", "frame_rate_hz = 1");
  std::ofstream(scene) << text;
  const Outcome rendered =
      runShell("%B render '" + scene.string() + "' -o '" + (folder / "loop").string() + "'");
  EXPECT_EQ(rendered.code, 0) << rendered.err;
  EXPECT_EQ(rendered.err.find("warning"), std::string::npos) << rendered.err;
  EXPECT_TRUE(fs::exists(folder / "loop/intensity/frame_0000.exr"));
}

TEST_F(HeartCommand, TruthIsWhatTheMeshesHold) {
  ASSERT_EQ(heart("--keyframes 4 --edv 150 --ef 0.5 --hr 80 --segment 4:0 --rule volumes").code, 0);
  const nlohmann::json truth = nlohmann::json::parse(bytesOf(folder / "heart/truth.json"));
  const auto measured = [&](const char* part, std::size_t keyframe) {
    const std::string name = part + std::string("_0") + std::to_string(keyframe) + ".obj";
    return millilitresOf(subdivided(meshOfObj(bytesOf(folder / ("heart/" + name)))));
  };
  const std::size_t es = truth["end_systole_keyframe"];
  const double edv = measured("lv_cavity", 0), esv = measured("lv_cavity", es);
  const nlohmann::json& left = truth["left_ventricle"];
  EXPECT_NEAR(left["edv_ml"].get<double>(), edv, 1e-3 * edv);
  EXPECT_NEAR(left["esv_ml"].get<double>(), esv, 1e-3 * edv);
  EXPECT_NEAR(left["ejection_fraction"].get<double>(), 1 - esv / edv, 1e-3);
  EXPECT_NEAR(edv, 150, 1.5);
  EXPECT_NEAR(1 - esv / edv, 0.5, 0.01);
  EXPECT_EQ(truth["parameters"]["hr"]["value"], 80);
  EXPECT_EQ(truth["parameters"]["segments"][3]["amplitude"], 0);
  ASSERT_EQ(truth["keyframes"].size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
    for (const char* part : {"lv_cavity", "lv_wall", "rv_cavity", "la", "ra", "aorta"}) {
      const double ml = measured(part, k);
      EXPECT_NEAR(truth["keyframes"][k]["volumes_ml"][part].get<double>(), ml, 1e-3 * ml) << part;
    }
}

}  // namespace
}  // namespace echocine
