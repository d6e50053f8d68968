// No construct of TOML nests deep enough to end the program.

#include <gtest/gtest.h>

#include "scene/toml_nesting.h"
#include "support/scene_text.h"

namespace echocine {
namespace {

using namespace support;

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(SceneNesting, OfEveryConstructIsRefusedWithItsLine) {
  for (const int depth : {40, 300, 50000}) {
    const std::string dotted = repeated("a.", depth) + "a";
    for (const std::string& line :
         {dotted + " = 1", "[" + dotted + "]", "[[" + dotted + "]]", "x = {" + dotted + " = 1}",
          "x = " + repeated("[", depth) + repeated("]", depth),
          "x = " + repeated("{a = ", depth) + "1" + repeated("}", depth),
          "x = " + repeated("[{a = ", depth) + "1" + repeated("}]", depth),
          repeated("\"a\" . ", depth) + "a = 1", "x = \"\"\"b\"\"\"\"\ny = {" + dotted + " = 1}",
          "x = {a = \"\"\"b\"\"\"\"\", " + dotted + " = 1}", repeated("'a'.", depth) + "a = 1"}) {
      const std::string refusal = refusalOf("# first\n" + line + "\n");
      EXPECT_TRUE(refusal.starts_with("scene.toml:")) << line.substr(0, 60);
      EXPECT_NE(refusal.find("nested deeper"), std::string::npos) << line.substr(0, 60) << refusal;
    }
  }
}

TEST(SceneNesting, DotsAndBracketsInTextAndCommentsAreNone) {
  const std::string dots = repeated("a.", 90) + repeated("[{", 90);
  for (const std::string& text :
       {"# " + dots + "\n", "x = \"" + dots + "\"\n", "x = '" + dots + "'\n",
        "x = \"\"\"" + dots + "\n\" " + dots + "\"\"\"\n", "x = '''" + dots + "'' '''\n",
        "x = \"\\\"" + dots + "\"\n", "x = [" + repeated("0.5, ", 90) + "]\n",
        repeated("a.b = 0.5\n", 90)})
    EXPECT_EQ(lineNestedTooDeep(text), 0) << text;
}

TEST(SceneNesting, ATextWithANulIsRefusedWhereAFileIsNamed) {
  SceneText text;
  text.addStructure("box", "blood", "\"box.obj\\u0000.txt\"");
  EXPECT_NE(refusalOf(text.text()).find("U+0000"), std::string::npos) << refusalOf(text.text());
}

TEST(SceneNesting, MoreKeyframesThanABeatHasFramesAreRefusedAtOnce) {
  SceneText text;
  text.addStructure("box", "blood", "[" + repeated("\"a.obj\", ", 200000) + "]");
  EXPECT_NE(refusalOf(text.text()).find("up to 4096"), std::string::npos);
}

}  // namespace
}  // namespace echocine
