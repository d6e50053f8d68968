// Only the effects that a scene calls for: with "auto" it gives the bytes that everything on gives,
// and the work counts show that what is off was not computed.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "render/render.h"
#include "support/exr_planes.h"
#include "support/loop_scene.h"
#include "trace/line_samples.h"

namespace echocine {
namespace {

using namespace support;

const char* const kSwitches[] = {"reflection",   "lobe",           "transmission_loss",
                                 "refraction",   "attenuation",    "backscatter",
                                 "spread",       "beam_width",     "travel_time",
                                 "snell_angles", "reflection_cap", "thin_layers"};

// Media that differ in nothing but what is given.
std::string mediaText(const char* kind, double z1, double z2, double c, double alpha, double eta1,
                      double eta2) {
  std::string text;
  for (const auto& [name, density, eta] :
       {std::tuple("outer", z1 / c, eta1), std::tuple("inner", z2 / c, eta2)})
    text += std::string("[media.") + name + "]\ndensity_kg_m3 = " + std::to_string(density) +
            "\nsound_speed_m_s = " + std::to_string(c) +
            "\nattenuation_db_cm_mhz = " + std::to_string(alpha) + "\nbackscatter = { kind = \"" +
            kind + "\"" +
            (std::string(kind) == "fixed" ? ", per_cm_sr = " + std::to_string(eta) : "") + " }\n";
  return text;
}

// A beating ball in a homogeneous medium, two frames, with echoes at the lines' centres (both
// tracers can).
SceneText ballText() {
  SceneText text;
  text.background = "outer";
  text.acquisition["frame_rate_hz"] = "2";
  text.accuracy["interface_echo"] = "\"centre\"";
  text.output["channels"] = "[\"unattenuated.Y\"]";
  text.addStructure("ball", "inner", "\"cavity_*.obj\"", 2, "reflection_exponent = 2.0\n");
  text.media = mediaText("fixed", 1.60e6, 1.70e6, 1540, 0.5, 1e-3, 1e-5);
  return text;
}

struct Rendered {
  nlohmann::json manifest;
  std::vector<std::uint32_t> bits;
  std::string cine;
};

Rendered render(const TempFolder& folder, const SceneText& text, const char* name, bool exr) {
  const std::filesystem::path file = folder.write(std::string(name) + ".toml", text.text());
  renderLoop(readScene(file),
             {.folder = folder / name, .threads = 2, .frames = {}, .resume = false}, {});
  Rendered run;
  run.manifest = nlohmann::json::parse(bytesOf(folder / name / "manifest.json"));
  if (exr) run.bits = exrPlane(folder / name / "intensity/frame_0001.exr", "unattenuated.Y").bits;
  run.cine = bytesOf(folder / name / "cine.avi");
  return run;
}

bool isOn(const Rendered& run, const std::string& effect) {
  for (const auto& e : run.manifest["effects"])
    if (e["name"] == effect) return e["on"];
  ADD_FAILURE() << "no effect " << effect;
  return false;
}

// The scene without the effect by itself, and with everything on.
struct Pair {
  Rendered automatic, forced;
};

Pair bothWays(SceneText text, bool exr = true) {
  const TempFolder folder;
  writeBallMeshes(folder);
  const Rendered automatic = render(folder, text, "auto", exr);
  for (const char* name : kSwitches) text.effects[name] = "\"on\"";
  const Rendered forced = render(folder, text, "forced", exr);
  EXPECT_EQ(automatic.bits, forced.bits);
  EXPECT_EQ(automatic.cine, forced.cine);
  return {automatic, forced};
}

TEST(EffectsCalledFor, AttenuationUnderPerfectGain) {
  const Pair runs = bothWays(ballText());
  EXPECT_FALSE(isOn(runs.automatic, "attenuation"));
  EXPECT_EQ(runs.automatic.manifest["work"]["samples_attenuated"], 0);
  EXPECT_TRUE(isOn(runs.forced, "attenuation"));
}

TEST(EffectsCalledFor, RefractionBetweenEqualSpeedsNeedsNoHierarchy) {
  const Pair runs = bothWays(ballText());
  EXPECT_FALSE(isOn(runs.automatic, "refraction"));
  EXPECT_EQ(runs.automatic.manifest["plan"]["tracer"], "slice");
  EXPECT_EQ(runs.automatic.manifest["work"]["bvh_updates"], 0);
  EXPECT_GT(runs.automatic.manifest["work"]["facets_sliced"], 0);
  EXPECT_FALSE(isOn(runs.forced, "refraction"));
  EXPECT_EQ(runs.forced.manifest["plan"]["tracer"], "slice");
}

TEST(EffectsCalledFor, ReflectionLossAndLobeBetweenEqualImpedances) {
  SceneText text = ballText();
  text.media = mediaText("fixed", 1.60e6, 1.60e6, 1540, 0.5, 1e-3, 1e-5);
  const Pair runs = bothWays(text);
  for (const char* name : {"reflection", "transmission_loss", "lobe"})
    EXPECT_FALSE(isOn(runs.automatic, name)) << name;
}

TEST(EffectsCalledFor, LobeOfExponentZero) {
  SceneText text = ballText();
  text.structures.replace(text.structures.find("exponent = 2.0"), 14, "exponent = 0.0");
  const Pair runs = bothWays(text);
  EXPECT_TRUE(isOn(runs.automatic, "reflection"));
  EXPECT_FALSE(isOn(runs.automatic, "lobe"));
}

TEST(EffectsCalledFor, BackscatterAndSpreadOfMediaThatDoNotScatter) {
  SceneText text = ballText();
  text.media = mediaText("none", 1.60e6, 1.70e6, 1540, 0.5, 0, 0);
  const Pair runs = bothWays(text);
  EXPECT_FALSE(isOn(runs.automatic, "backscatter"));
  EXPECT_FALSE(isOn(runs.automatic, "spread"));
  EXPECT_EQ(runs.automatic.manifest["work"]["samples_backscatter"], 0);
}

TEST(EffectsCalledFor, SpreadThatTheDisplayCompensates) {
  SceneText text = ballText();
  text.output.erase("channels");
  text.output["exr"] = "false";
  const Pair runs = bothWays(text, false);
  EXPECT_FALSE(isOn(runs.automatic, "spread"));
  EXPECT_TRUE(isOn(runs.automatic, "backscatter"));
}

TEST(EffectsCalledFor, BeamNoWiderThanASample) {
  SceneText text = ballText();
  text.signal["beam_width"] = "\"none\"";
  text.signal["pulse_cycles"] = "0.0";
  EXPECT_FALSE(isOn(bothWays(text).automatic, "beam_width"));
}

TEST(EffectsCalledFor, TravelTimeAtTheScannersOwnSpeed) {
  EXPECT_FALSE(isOn(bothWays(ballText()).automatic, "travel_time"));
}

TEST(EffectsCalledFor, PictureWhenNoneIsAskedFor) {
  SceneText text = ballText();
  text.output["cine"] = "false";
  const TempFolder folder;
  writeBallMeshes(folder);
  const Rendered run = render(folder, text, "auto", true);
  EXPECT_FALSE(isOn(run, "beam_width"));
  EXPECT_FALSE(isOn(run, "log_compression"));
  EXPECT_EQ(run.manifest["timings_ms_per_frame"]["scan_conversion"], 0);
}

TEST(EffectsCalledFor, TruthIsTimedWhereItIsAskedFor) {
  SceneText text = ballText();
  const TempFolder folder;
  writeBallMeshes(folder);
  EXPECT_EQ(render(folder, text, "plain", false).manifest["timings_ms_per_frame"]["truth"], 0);
  text.extra += "[truth]\nwrite = [\"labels\"]\n";
  EXPECT_GT(render(folder, text, "asked", false).manifest["timings_ms_per_frame"]["truth"], 0);
}

TEST(EffectsCalledFor, ForcedOffIsSaidInTheManifest) {
  SceneText text = ballText();
  text.effects["reflection"] = "\"off\"";
  const TempFolder folder;
  writeBallMeshes(folder);
  const Rendered run = render(folder, text, "off", true);
  EXPECT_FALSE(isOn(run, "reflection"));
  EXPECT_NE(run.manifest["effects"][0]["reason"].get<std::string>().find(
                "the scene disables it, although"),
            std::string::npos);
}

TEST(EffectsCalledFor, StructuresThatNoFrameShowsAreLeftOut) {
  SceneText text = ballText();
  text.structures +=
      "[[structure]]\nname = \"aside\"\nmedium = \"inner\"\npriority = 3\nkeyframes = "
      "\"aside.obj\"\n";
  text.structures +=
      "[[structure]]\nname = \"unseen\"\nmedium = \"outer\"\npriority = 1\nkeyframes = "
      "\"wall_*.obj\"\n";
  const TempFolder folder;
  writeBallMeshes(folder);
  writeObj(icosphere(2, 1).moved({0, 3, 6}),
           folder / "aside.obj");  // 2 cm beside the imaging plane
  const Rendered with = render(folder, text, "with", true);
  const Rendered without = render(folder, ballText(), "without", true);
  EXPECT_EQ(with.bits, without.bits);
  EXPECT_EQ(with.cine, without.cine);
  EXPECT_EQ(with.manifest["work"]["facets_sliced"], without.manifest["work"]["facets_sliced"]);
  std::string names;
  for (const auto& left : with.manifest["plan"]["left_out"])
    names += left["name"].get<std::string>() + " ";
  EXPECT_NE(names.find("aside"), std::string::npos) << names;
  EXPECT_NE(names.find("unseen"), std::string::npos) << names;
}

// Labels do not depend on which other channels are there, also behind total reflection.
TEST(EffectsCalledFor, LabelsAloneAreLabelsBesideIntensities) {
  const TempFolder folder;
  writeBallMeshes(folder);
  const auto labels = [&](const char* channels, const char* name) {
    SceneText text = ballText();
    text.output["channels"] = channels;
    text.output["cine"] = "false";
    const std::size_t at = text.media.rfind("sound_speed_m_s = 1540");
    text.media.replace(at, 29, "sound_speed_m_s = 3000");
    render(folder, text, name, false);
    return exrPlane(folder / name / "intensity/frame_0001.exr", "medium.id").bits;
  };
  const std::vector<std::uint32_t> alone = labels("[\"medium.id\"]", "alone");
  EXPECT_EQ(alone, labels("[\"medium.id\", \"Y\"]", "beside"));
  EXPECT_GT(std::count(alone.begin(), alone.end(), kNoMedium), 0);
}

// Bent rays, decided by tracing: a thin contrast of speed stays within the tolerance, a strong one
// does not.
TEST(EffectsCalledFor, RefractionIsDecidedByHowFarEchoesMove) {
  const TempFolder folder;
  writeBallMeshes(folder);
  const auto withInnerSpeed = [&](const char* speed, const char* name) {
    SceneText text = ballText();
    const std::size_t at = text.media.rfind("sound_speed_m_s = 1540");
    text.media.replace(at, 29, std::string("sound_speed_m_s = ") + speed);
    return render(folder, text, name, true);
  };
  const Rendered slight = withInnerSpeed("1540.2", "slight"),
                 strong = withInnerSpeed("1450", "strong");
  EXPECT_FALSE(isOn(slight, "refraction"));
  EXPECT_TRUE(isOn(strong, "refraction"));
  EXPECT_NE(slight.manifest["effects"][3]["reason"].get<std::string>().find("echoes move by up to"),
            std::string::npos);
}

// A pearl beside the imaging plane: one ray per line never meets it, a lens does.
TEST(EffectsCalledFor, AStructureBesideTheImagingPlaneIsKeptForRaysThatReachIt) {
  const TempFolder folder;
  writeObj(icosphere(1, 0.2).moved({0, 0.5, 4}), folder / "pearl.obj");
  const auto run = [&](const char* rays, const char* elevation) {
    SceneText text = ballScene(1);
    text.addStructure("pearl", "fat", "\"pearl.obj\"", 5);
    text.accuracy["rays_per_beam"] = rays;
    text.effects = {{"elevation", elevation}, {"refraction", "\"off\""}};
    const Scene scene = readScene(writeBall(folder, text));
    const std::filesystem::path out = folder / (std::string(rays) + elevation[1] + elevation[2]);
    return renderLoop(scene, {.folder = out, .threads = 2, .frames = {}}, {}).manifest;
  };
  const auto leftOut = [](const Manifest& manifest) {
    const auto& list = manifest.plan.interfaces;
    return std::any_of(list.begin(), list.end(),
                       [](const Omission& o) { return o.name == "pearl"; });
  };
  EXPECT_TRUE(leftOut(run("1", "\"auto\"")));
  EXPECT_TRUE(leftOut(run("64", "\"off\"")));
  const Manifest kept = run("64", "\"auto\"");
  EXPECT_FALSE(leftOut(kept));
  EXPECT_EQ(kept.plan.effects.rays_per_beam, 64);
  EXPECT_GE(kept.work.rays, 32u * 64);
}

}  // namespace
}  // namespace echocine
