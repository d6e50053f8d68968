// A scene that cannot be used is refused with `file:line: key: what is wrong, what is accepted`.

#include <gtest/gtest.h>

#include <functional>

#include "support/scene_text.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

// One way to break the working scene, and what the message must say.
struct Bad {
  std::string what;  // name of the case
  std::function<void(SceneText&)> change;
  std::string key;         // full key named in the message
  std::string line_start;  // text of the line that the message points to; empty: any
  std::string says;        // part of the rest
};

std::function<void(SceneText&)> probe(const std::string& key, const std::string& value) {
  return [=](SceneText& t) { t.probe[key] = value; };
}
std::function<void(SceneText&)> without(const std::string& key) {
  return [=](SceneText& t) { t.probe.erase(key); };
}
std::function<void(SceneText&)> output(const std::string& key, const std::string& value) {
  return [=](SceneText& t) { t.output[key] = value; };
}
std::function<void(SceneText&)> structure(const std::string& medium, const std::string& keyframes,
                                          const std::string& more = "") {
  return [=](SceneText& t) {
    t.structures.clear();
    t.addStructure("lv", medium, keyframes, 1, more);
  };
}
std::function<void(SceneText&)> blood(const std::string& hematocrit) {
  return [=](SceneText& t) {
    t.media =
        "[media.ink]\ndensity_kg_m3 = 1000\nsound_speed_m_s = 1500\nattenuation_db_cm_mhz = 0\n"
        "[media.ink.backscatter]\nkind = \"blood\"\nhematocrit = " +
        hematocrit +
        "\ncell_radius_um = 3\ncell_density_kg_m3 = 1092\ncell_compressibility_cm2_dyn = 3e-11\n";
  };
}
std::function<void(SceneText&)> extra(const std::string& text) {
  return [=](SceneText& t) { t.extra = text; };
}

const std::vector<Bad> kBad{
    {"unknown key", probe("dept_mm", "100"), "probe.dept_mm", "dept_mm", "depth_mm"},
    {"unknown key far from any", probe("xyzzyplugh", "1"), "probe.xyzzyplugh", "xyzzyplugh",
     "accepted: "},
    {"unknown table", extra("[prob]\nx = 1\n"), "prob", "[prob]", "probe"},
    {"unknown key at the top", [](SceneText& t) { t.background += "\"\nbackgroud = \"blood"; },
     "backgroud", "backgroud", "background"},
    {"string for a number", probe("depth_mm", "\"deep\""), "probe.depth_mm", "depth_mm",
     "a string"},
    {"boolean for a number", probe("depth_mm", "true"), "probe.depth_mm", "depth_mm", "a boolean"},
    {"number for a choice", probe("kind", "3"), "probe.kind", "kind", "phased"},
    {"unknown choice", probe("kind", "\"sparse\""), "probe.kind", "kind", "curvilinear"},
    {"fraction of lines", probe("lines", "2.5"), "probe.lines", "lines", "whole number"},
    {"no lines", probe("lines", "0"), "probe.lines", "lines", "from 1"},
    {"absurdly many samples", probe("samples", "70000"), "probe.samples", "samples", "65536"},
    {"absurdly many of both", [](SceneText& t) { t.probe["lines"] = t.probe["samples"] = "65536"; },
     "probe.samples", "samples", "accepted"},
    {"integer past 64 bits", probe("lines", "99999999999999999999"), "", "lines", "not TOML"},
    {"negative depth", probe("depth_mm", "-1"), "probe.depth_mm", "depth_mm", "over 0"},
    {"infinite depth", probe("depth_mm", "inf"), "probe.depth_mm", "depth_mm", "over 0"},
    {"not a number", probe("frequency_mhz", "nan"), "probe.frequency_mhz", "frequency_mhz", "0.1"},
    {"depth above the shallowest", probe("min_depth_mm", "130"), "probe.depth_mm", "depth_mm",
     "min_depth_mm"},
    {"missing depth", without("depth_mm"), "probe.depth_mm", "[probe]", "is missing"},
    {"sector of nothing", probe("sector_deg", "0"), "probe.sector_deg", "sector_deg", "180"},
    {"sector over half a turn", probe("sector_deg", "181"), "probe.sector_deg", "sector_deg",
     "180"},
    {"frequency in hertz", probe("frequency_mhz", "2500000"), "probe.frequency_mhz",
     "frequency_mhz", "100"},
    {"axis of two numbers", probe("axis", "[0, 1]"), "probe.axis", "axis", "[x, y, z]"},
    {"axis with text", probe("axis", "[0, 0, \"z\"]"), "probe.axis", "axis", "three"},
    {"axis of length zero", probe("axis", "[0, 0, 0]"), "probe.axis", "axis", "zero vector"},
    {"axis parallel to lateral", probe("lateral", "[0, 0, 2]"), "probe.lateral", "lateral",
     "parallel"},
    {"apex at infinity", probe("apex", "[0, 0, inf]"), "probe.apex", "apex", "finite"},
    {"linear without a width",
     [](SceneText& t) {
       t.probe["kind"] = "\"linear\"";
       t.probe.erase("sector_deg");
     },
     "probe.width_mm", "[probe]", "is missing"},
    {"heart rate of nothing", [](SceneText& t) { t.acquisition["heart_rate_bpm"] = "0"; },
     "acquisition.heart_rate_bpm", "heart_rate_bpm", "1"},
    {"a loop of weeks", [](SceneText& t) { t.acquisition["beats"] = "1e6"; }, "acquisition.beats",
     "beats", "frames"},
    {"subdivision past reason", [](SceneText& t) { t.motion["subdivision"] = "9"; },
     "motion.subdivision", "subdivision", "8"},
    {"mesh unit", [](SceneText& t) { t.motion["mesh_unit"] = "\"inch\""; }, "motion.mesh_unit",
     "mesh_unit", "cm"},
    {"effect switch", [](SceneText& t) { t.effects["refraction"] = "true"; }, "effects.refraction",
     "refraction", "auto"},
    {"hematocrit over 1", blood("1.01"), "media.ink.backscatter.hematocrit", "hematocrit",
     "from 0 to 1"},
    {"hematocrit below 0", blood("-0.1"), "media.ink.backscatter.hematocrit", "hematocrit",
     "from 0 to 1"},
    {"medium without density", extra("[media.void]\nsound_speed_m_s = 1500\n"),
     "media.void.density_kg_m3", "[media.void]", "is missing"},
    {"unknown medium", structure("blod", "\"a.obj\""), "structure.medium", "medium",
     "nearest: blood"},
    {"unknown background", [](SceneText& t) { t.background = "vacuum"; }, "background",
     "background", "soft_tissue"},
    {"pattern without files", structure("blood", "\"none_*.obj\""), "structure.keyframes",
     "keyframes", "no file matches"},
    {"no keyframes", structure("blood", "[]"), "structure.keyframes", "keyframes", "empty"},
    {"phases out of order",
     structure("blood", "[{file=\"a.obj\",phase=0.5},{file=\"b.obj\",phase=0.25}]"),
     "structure.keyframes.phase", "keyframes", "ascending"},
    {"phase of 1", structure("blood", "[{file=\"a.obj\",phase=1.0}]"), "structure.keyframes.phase",
     "keyframes", "under 1"},
    {"lids too few", structure("blood", "[\"a.obj\",\"b.obj\"]", "lids = \"lid.obj\""),
     "structure.lids", "lids", "2 keyframes"},
    {"name taken", [](SceneText& t) { t.addStructure("box", "blood", "\"b.obj\""); },
     "structure.name", "", "taken"},
    {"negative gain", structure("blood", "\"a.obj\"", "reflection_gain = -1"),
     "structure.reflection_gain", "reflection_gain", "0"},
    {"no structure", [](SceneText& t) { t.structures.clear(); }, "structure", "", "at least one"},
    {"bad channel", output("channels", "[\"Z\"]"), "output.channels", "channels", "attenuation.A"},
    {"no channel", output("channels", "[]"), "output.channels", "channels", "at least one"},
    {"picture too large", output("width", "100000"), "output.width", "width", "16384"},
    {"number for a switch", output("exr", "1"), "output.exr", "exr", "true | false"},
    {"time gain out of order",
     [](SceneText& t) {
       t.signal = {{"tgc", "\"table\""}, {"tgc_table_mm_db", "[[50, 1], [40, 2]]"}};
     },
     "signal.tgc_table_mm_db", "tgc_table_mm_db", "ascend"},
    {"time gain without a table", [](SceneText& t) { t.signal["tgc"] = "\"table\""; },
     "signal.tgc_table_mm_db", "[signal]", "missing"},
    {"not TOML", extra("this is not TOML\n"), "", "this is", "not TOML"},
    {"a key twice", extra("[probe]\n"), "", "", "not TOML"},
};

TEST(SceneRefusal, TheSceneThatIsBrokenBelowWorks) {
  EXPECT_EQ(refusalOf(SceneText::oneBox("blood").text()), "");
}

TEST(SceneRefusal, EveryBadInputIsNamedWithItsLineItsKeyAndWhatIsAccepted) {
  for (const Bad& bad : kBad) {
    SCOPED_TRACE(bad.what);
    SceneText scene = SceneText::oneBox("blood");
    bad.change(scene);
    const std::string text = scene.text(), message = refusalOf(text, "heart.toml");
    EXPECT_TRUE(message.starts_with("heart.toml:")) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find(bad.says), std::string::npos) << message;
    if (!bad.key.empty()) {
      EXPECT_NE(message.find(": " + bad.key + ": "), std::string::npos) << message;
    }
    if (!bad.line_start.empty()) {
      const std::string place = "heart.toml:" + std::to_string(lineOf(text, bad.line_start)) + ":";
      EXPECT_TRUE(message.starts_with(place)) << message << "\nexpected " << place;
    }
  }
}

TEST(SceneRefusal, AMissingFileAndAFolderAreNamed) {
  const TempFolder folder;
  for (const std::filesystem::path& path : {folder / "none.toml", folder.path()}) {
    try {
      readScene(path);
      FAIL() << "accepted " << path;
    } catch (const SceneError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path.string() + ": ")) << error.what();
    }
  }
}

TEST(SceneRefusal, AHugeFileIsNotReadToItsEnd) {
  const TempFolder folder;
  folder.write("huge.toml", std::string(5 << 20, '#'));
  EXPECT_THROW(readScene(folder / "huge.toml"), SceneError);
}

TEST(SceneRefusal, BytesThatAreNotTextAreRefusedAndDeepNestingDoesNotCrash) {
  EXPECT_NE(refusalOf(std::string("\xff\xfe\x00\x01", 4)), "");
  EXPECT_NE(refusalOf("x = " + std::string(100000, '[')), "");
}

}  // namespace
}  // namespace echocine
