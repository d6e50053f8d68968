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
std::function<void(SceneText&)> acquisition(const std::string& key, const std::string& value) {
  return [=](SceneText& t) { t.acquisition[key] = value; };
}
std::function<void(SceneText&)> motion(const std::string& key, const std::string& value) {
  return [=](SceneText& t) { t.motion[key] = value; };
}
std::function<void(SceneText&)> accuracy(const std::string& key, const std::string& value) {
  return [=](SceneText& t) { t.accuracy[key] = value; };
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
    {"negative depth", probe("depth_mm", "-1"), "probe.depth_mm", "depth_mm", "from 0.001"},
    {"infinite depth", probe("depth_mm", "inf"), "probe.depth_mm", "depth_mm", "from 0.001"},
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
    {"beats that vary past reason", acquisition("rr_variability", "0.31"),
     "acquisition.rr_variability", "rr_variability", "from 0 to 0.3"},
    {"negative variability", acquisition("rr_variability", "-0.01"), "acquisition.rr_variability",
     "rr_variability", "from 0 to 0.3"},
    {"variability in per cent", acquisition("rr_variability", "\"5 %\""),
     "acquisition.rr_variability", "rr_variability", "a string"},
    {"negative seed", acquisition("seed", "-1"), "acquisition.seed", "seed", "from 0"},
    {"fraction of a seed", acquisition("seed", "1.5"), "acquisition.seed", "seed", "whole number"},
    {"unknown time warp", acquisition("time_warp", "\"linear\""), "acquisition.time_warp",
     "time_warp", "systole"},
    {"systole without the keyframes' rate", acquisition("time_warp", "\"systole\""),
     "acquisition.time_warp", "time_warp", "keyframe_heart_rate_bpm"},
    {"keyframes of no heart rate", motion("keyframe_heart_rate_bpm", "0"),
     "motion.keyframe_heart_rate_bpm", "keyframe_heart_rate_bpm", "from 1 to 1000"},
    {"keyframes' rate in text", motion("keyframe_heart_rate_bpm", "\"65 bpm\""),
     "motion.keyframe_heart_rate_bpm", "keyframe_heart_rate_bpm", "a string"},
    {"end-systole without a rate", motion("end_systole_phase", "0.35"), "motion.end_systole_phase",
     "end_systole_phase", "keyframe_heart_rate_bpm"},
    {"end-systole in per cent",
     [](SceneText& t) {
       t.motion["keyframe_heart_rate_bpm"] = "65";
       t.motion["end_systole_phase"] = "35";
     },
     "motion.end_systole_phase", "end_systole_phase", "from 0.1 to 0.8"},
    {"subdivision past reason", [](SceneText& t) { t.motion["subdivision"] = "9"; },
     "motion.subdivision", "subdivision", "8"},
    {"mesh unit", [](SceneText& t) { t.motion["mesh_unit"] = "\"inch\""; }, "motion.mesh_unit",
     "mesh_unit", "cm"},
    {"effect switch", [](SceneText& t) { t.effects["refraction"] = "true"; }, "effects.refraction",
     "refraction", "auto"},
    {"normals", [](SceneText& t) { t.accuracy["normals"] = "\"phong\""; }, "accuracy.normals",
     "normals", "facet"},
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
     "keyframes", "at least 0 and below 1"},
    {"beat closed by a frame at 1",
     structure("blood", "[{file=\"a.obj\",phase=0.5},{file=\"b.obj\",phase=1.0}]"),
     "structure.keyframes.phase", "keyframes", "drop the frame that closes the beat"},
    {"lids too few", structure("blood", "[\"a.obj\",\"b.obj\"]", "lids = \"lid.obj\""),
     "structure.lids", "lids", "2 keyframes"},
    {"name taken", [](SceneText& t) { t.addStructure("box", "blood", "\"b.obj\""); },
     "structure.name", "", "already used"},
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
    {"equal phases", structure("blood", "[{file=\"a.obj\",phase=0.5},{file=\"b.obj\",phase=0.5}]"),
     "structure.keyframes.phase", "keyframes", "is 0.5 after 0.5, accepted: ascending phases"},
    {"time gain table with perfect gain",
     [](SceneText& t) { t.signal["tgc_table_mm_db"] = "[[0, 0], [100, 20]]"; },
     "signal.tgc_table_mm_db", "tgc_table_mm_db",
     "is a known key, but not used here, accepted only with tgc = \"table\""},
    {"width of a focused beam", [](SceneText& t) { t.signal["beam_width_mm"] = "3"; },
     "signal.beam_width_mm", "beam_width_mm", "accepted only with beam_width = \"fixed\""},
    {"percentile beside an absolute reference",
     [](SceneText& t) {
       t.signal = {{"reference_intensity", "1"}, {"reference_percentile", "99"}};
     },
     "signal.reference_percentile", "reference_percentile",
     "accepted only with reference_intensity left out"},
    {"no ray", accuracy("rays_per_beam", "0"), "accuracy.rays_per_beam", "rays_per_beam", "1"},
    {"too many rays", accuracy("rays_per_beam", "4097"), "accuracy.rays_per_beam", "rays_per_beam",
     "4096"},
    {"rays that spread over nothing",
     [](SceneText& t) {
       t.accuracy["rays_per_beam"] = "8";
       t.signal["beam_width"] = "\"none\"";
       t.effects["elevation"] = "\"off\"";
     },
     "accuracy.rays_per_beam", "rays_per_beam",
     "effects.elevation = \"off\" and signal.beam_width = \"none\" the beam has no width, "
     "accepted with them: 1"},
    {"rays over nothing by effects",
     [](SceneText& t) {
       t.accuracy["rays_per_beam"] = "8";
       t.effects = {{"beam_width", "\"off\""}, {"elevation", "\"off\""}};
     },
     "accuracy.rays_per_beam", "rays_per_beam", "effects.beam_width = \"off\""},
    {"an even number of slices", accuracy("elevation_slices", "4"), "accuracy.elevation_slices",
     "elevation_slices", "1, 3 or 5"},
    {"lens without a size", probe("elevation_aperture_mm", "0"), "probe.elevation_aperture_mm",
     "elevation_aperture_mm", "from 0.001"},
    {"lens focused at its face", probe("elevation_focus_mm", "0"), "probe.elevation_focus_mm",
     "elevation_focus_mm", "from 0.001"},
    {"width of a sector", probe("width_mm", "40"), "probe.width_mm", "width_mm",
     "accepted only with kind = \"linear\""},
    {"face radius of a phased array", probe("face_radius_mm", "40"), "probe.face_radius_mm",
     "face_radius_mm", "accepted only with kind = \"curvilinear\""},
    {"sector of a linear array",
     [](SceneText& t) {
       t.probe["kind"] = "\"linear\"";
       t.probe["width_mm"] = "40";
     },
     "probe.sector_deg", "sector_deg", "accepted only with kind = \"phased\" | \"curvilinear\""},
    {"priority of a membrane", structure("valve", "\"a.obj\"", "membrane = true"),
     "structure.priority", "priority", "accepted only with membrane = false"},
    {"misspelt repair", structure("blood", "\"a.obj\"", "repair = [\"weld\", \"orientt\"]"),
     "structure.repair", "repair",
     "holds \"orientt\", accepted: \"weld\" | \"orient\" | \"drop-degenerate\" | \"split\" | "
     "\"fill-holes\"; "
     "nearest: orient"},
    {"repair far from any word", structure("blood", "\"a.obj\"", "repair = \"xyzzyplugh\""),
     "structure.repair", "repair", "\"fill-holes\""},
    {"switch for a repair", structure("blood", "\"a.obj\"", "repair = true"), "structure.repair",
     "repair", "a string or a list of strings"},
    {"number among repairs", structure("blood", "\"a.obj\"", "repair = [\"weld\", 1]"),
     "structure.repair", "repair", "accepted: strings"},
    {"filled membrane",
     structure("valve", "\"a.obj\"", "membrane = true\nrepair = [\"fill-holes\"]"),
     "structure.repair", "repair", "accepted for a membrane: \"weld\""},
    {"hematocrit of a fixed scatterer",
     extra("[media.ink]\ndensity_kg_m3 = 1000\nsound_speed_m_s = 1500\nattenuation_db_cm_mhz = 0\n"
           "backscatter = { kind = \"fixed\", per_cm_sr = 1e-3, hematocrit = 0.4 }\n"),
     "media.ink.backscatter.hematocrit", "backscatter", "accepted only with kind = \"blood\""},
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
