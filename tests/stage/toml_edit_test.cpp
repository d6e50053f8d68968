// Changes of single keys in the text of a scene.

#include <gtest/gtest.h>

#include "core/error.h"
#include "scene/toml_edit.h"
#include "scene/toml_flat.h"

namespace echocine {
namespace {

const std::string kText =
    "# Größe\nbackground = \"soft_tissue\"\n\n[probe]\ndepth_mm = 160   # tief\n"
    "apex = [1, 2,\n  3]  # Ort\nview = \"a4c\"\n[[structure]]\nname = \"wall\"\n[signal]\ngain_db "
    "= 0";

std::string edited(const std::string& key, std::optional<std::string> value) {
  return withEdits(kText, {{key, std::move(value)}}, "scene.toml");
}

TEST(TomlEdit, ReplacesAValueAndNothingElse) {
  const std::string text = edited("probe.depth_mm", "90.5");
  EXPECT_NE(text.find("depth_mm = 90.5   # tief\n"), std::string::npos) << text;
  auto values = flatValues(text, ""), before = flatValues(kText, "");
  values.erase("probe.depth_mm");
  before.erase("probe.depth_mm");
  EXPECT_EQ(values, before);
  EXPECT_NE(edited("probe.apex", "[4, 5, 6]").find("apex = [4, 5, 6]  # Ort\n"), std::string::npos);
  EXPECT_TRUE(edited("background", "\"blood\"").starts_with("# Größe\nbackground = \"blood\"\n"));
  EXPECT_TRUE(edited("signal.gain_db", "3").ends_with("gain_db = 3"));
}

TEST(TomlEdit, AddsAndRemovesKeys) {
  EXPECT_EQ(flatValues(edited("probe.lines", "64"), "").at("probe.lines"), "64");
  EXPECT_EQ(flatValues(edited("speckle.on", "true"), "").at("speckle.on"), "true");
  EXPECT_EQ(flatValues(edited("unit_volume_cm3", "2"), "").at("unit_volume_cm3"), "2");
  const std::string without = edited("probe.apex", std::nullopt);
  EXPECT_FALSE(flatValues(without, "").contains("probe.apex"));
  EXPECT_NE(without.find("tief\nview"), std::string::npos) << without;
  EXPECT_EQ(edited("probe.lines", std::nullopt), kText);
}

TEST(TomlEdit, RemovesAKeyOfAnInlineTableAlone) {
  const std::string text = "probe = { view = \"plax\", lines = 64 , depth_mm = 120 }\ngain = 3\n";
  for (const char* key : {"view", "lines", "depth_mm"}) {
    const std::string name = std::string("probe.") + key;
    auto values = flatValues(text, "");
    values.erase(name);
    EXPECT_EQ(flatValues(withEdits(text, {{name, std::nullopt}}, ""), ""), values) << key;
  }
  const std::string none = withEdits(text,
                                     {{"probe.view", std::nullopt},
                                      {"probe.depth_mm", std::nullopt},
                                      {"probe.lines", std::nullopt}},
                                     "");
  EXPECT_EQ(flatValues(none, "").at("gain"), "3") << none;
}

TEST(TomlEdit, AnEditAndItsReverseGiveTheTextBack) {
  const std::string there = edited("probe.depth_mm", "12");
  EXPECT_EQ(withEdits(there, {{"probe.depth_mm", "160"}}, ""), kText);
}

TEST(TomlEdit, RefusesValuesThatAreMoreThanOne) {
  for (const char* value : {"1\nlines = 2", "1 # 2", "", "[1", "1 2", "\"a"})
    EXPECT_THROW(edited("probe.depth_mm", value), SceneError) << value;
  EXPECT_THROW(edited("structure.name", "\"x\""), SceneError);
  EXPECT_THROW(withEdits("probe = { a = 1 }", {{"probe.b", "2"}}, ""), SceneError);
  EXPECT_THROW(withEdits("probe = [", {}, ""), SceneError);
}

}  // namespace
}  // namespace echocine
