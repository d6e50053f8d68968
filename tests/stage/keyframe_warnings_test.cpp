// Lists of keyframes that are accepted but hardly meant.

#include "scene/keyframe_warnings.h"

#include <gtest/gtest.h>

#include "support/scene_text.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

class KeyframeWarnings : public ::testing::Test {
 protected:
  void touch(const std::string& stem, int count) {
    for (int i = 0; i < count; ++i) folder.write(stem + std::to_string(i) + ".obj", "");
  }
  std::vector<std::string> warningsOf(const SceneText& text) {
    return readScene(folder.write("scene.toml", text.text())).warnings;
  }
  // "<scene>:<line of the n-th keyframes key>: structure.keyframes: "
  std::string place(const SceneText& text, int nth) const {
    const std::string all = text.text();
    std::size_t at = 0;
    for (int i = 0; i <= nth; ++i) at = all.find("\nkeyframes", at) + 1;
    const auto line = 1 + std::count(all.begin(), all.begin() + static_cast<long>(at), '\n');
    return (folder / "scene.toml").string() + ":" + std::to_string(line) +
           ": structure.keyframes: ";
  }
  TempFolder folder;
};

TEST_F(KeyframeWarnings, PatternsThatKeepStructuresApartAreSilent) {
  touch("la_", 4);
  touch("la_wall_", 4);
  SceneText text;
  text.addStructure("la", "blood", "\"la_?.obj\"");
  text.addStructure("la_wall", "myocardium", "\"la_wall_*.obj\"");
  EXPECT_TRUE(warningsOf(text).empty());
}

TEST_F(KeyframeWarnings, APatternThatTakesAnotherStructuresFilesNamesBoth) {
  touch("la_", 4);
  touch("la_wall_", 4);
  SceneText text;
  text.addStructure("la_wall", "myocardium", "\"la_wall_*.obj\"");
  text.addStructure("la", "blood", "\"la_*.obj\"");
  const std::vector<std::string> warnings = warningsOf(text);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0], place(text, 1) +
                             "la: its 8 keyframes include all 4 of structure la_wall, "
                             "such as " +
                             (folder / "la_wall_0.obj").string() +
                             ": a pattern that matches fewer files (? is one character) separates "
                             "them");
  EXPECT_EQ(warnings[1], place(text, 1) +
                             "la: has 8 keyframes, structure la_wall has 4: each is spread evenly "
                             "over the beat, so their instants differ; {file, phase} sets them");
}

TEST_F(KeyframeWarnings, TheOddOneOutOfManyIsNamed) {
  for (const char* stem : {"a_", "b_", "c_"}) touch(stem, 5);
  folder.write("a_5.obj", "");
  SceneText text;
  for (const char* name : {"a", "b", "c"})
    text.addStructure(name, "blood", "\"" + std::string(name) + "_*.obj\"");
  const std::vector<std::string> warnings = warningsOf(text);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with(place(text, 0) + "a: has 6 keyframes, structure b has 5: "))
      << warnings[0];
}

TEST_F(KeyframeWarnings, StillStructuresAndGivenPhasesMayDifferInNumber) {
  touch("a_", 5);
  touch("b_", 2);
  SceneText text;
  text.addStructure("a", "blood", "\"a_*.obj\"");
  text.addStructure("b", "blood", "[{file=\"b_0.obj\",phase=0},{file=\"b_1.obj\",phase=0.4}]");
  text.addStructure("still", "blood", "\"still.obj\"");
  EXPECT_TRUE(warningsOf(text).empty());
}

TEST_F(KeyframeWarnings, ALoopInWhichNothingMovesIsNamed) {
  SceneText text = SceneText::oneBox("blood");
  EXPECT_EQ(warningsOf(text),
            std::vector{place(text, 0) + "box: every structure has one keyframe, so the loop's 5 "
                                         "frames are all the same: list keyframes, or shorten "
                                         "acquisition.beats"});
  text.acquisition["beats"] = "0.2";  // one frame
  EXPECT_TRUE(warningsOf(text).empty());
}

}  // namespace
}  // namespace echocine
