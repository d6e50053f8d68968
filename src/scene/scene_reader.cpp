#include "scene/scene_reader.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "scene/contradictions.h"
#include "scene/key_reader.h"
#include "scene/keyframe_warnings.h"
#include "scene/media_reader.h"
#include "scene/motion_reader.h"
#include "scene/probe_reader.h"
#include "scene/signal_reader.h"
#include "scene/structure_reader.h"
#include "scene/toml_table.h"
#include "scene/truth_reader.h"

namespace echocine {

namespace {

constexpr std::size_t kMaxSceneBytes = 4 << 20;
constexpr double kMaxFrames = 1e6;

// keyframe_rate_hz: of the loop where it names no heart rate of its own.
void readAcquisition(TomlTable table, std::optional<double> keyframe_rate_hz, Scene& scene) {
  readKeys(table, "acquisition", {&scene});
  Acquisition& a = scene.acquisition;
  if (keyframe_rate_hz && !table.has("heart_rate_bpm")) a.heart_rate_hz = *keyframe_rate_hz;
  if (a.beats / a.heart_rate_hz * a.frame_rate_hz > kMaxFrames)
    table.fail("beats", fmt::format("the loop would have over {} frames", kMaxFrames));
  table.finish();
}

std::vector<Channel> readChannels(TomlTable& table) {
  std::vector<Channel> channels;
  for (const std::string& name : table.texts("channels")) {
    std::vector<Channel> known(kAllChannels.begin(), kAllChannels.end());
    known.insert(known.end(), kTruthChannels.begin(), kTruthChannels.end());
    const auto found =
        std::find_if(known.begin(), known.end(), [&](Channel c) { return channelName(c) == name; });
    if (found == known.end()) {
      std::string accepted;
      for (const Channel c : known)
        accepted += (accepted.empty() ? "" : ", ") + std::string(channelName(c));
      table.fail("channels", fmt::format("\"{}\" is not a channel, accepted: {}", name, accepted));
    }
    channels.push_back(*found);
  }
  std::sort(channels.begin(), channels.end());
  channels.erase(std::unique(channels.begin(), channels.end()), channels.end());
  return channels;
}

void readOutput(TomlTable table, Scene& scene) {
  readKeys(table, "output", {&scene});
  OutputSettings& o = scene.output;
  o.channels_given = table.has("channels");
  if (o.channels_given) o.channels = readChannels(table);
  if (o.channels.empty()) table.fail("channels", "is empty, accepted: at least one channel");
  table.finish();
}

void readAccuracy(TomlTable table, Scene& scene) {
  readKeys(table, "accuracy", {&scene});
  const int slices = scene.accuracy.elevation_slices;
  if (slices % 2 == 0)
    table.fail("elevation_slices", fmt::format("is {}, accepted: 1, 3 or 5", slices));
  scene.accuracy.normals_place = table.place("normals");
  constexpr std::string_view kTolerance = "tolerance_db";
  if (table.has(kTolerance)) {
    scene.accuracy.tolerance_db = readNumber(table, sceneKey("accuracy", kTolerance));
    scene.accuracy.tolerance_place = table.place(kTolerance);
  }
  table.finish();
}

void readPlain(TomlTable table, const char* name, Scene& scene) {
  readKeys(table, name, {&scene});
  table.finish();
}

// Gives each medium that the scene uses one id and its numbers at the probe's frequency.
class MediaInUse {
 public:
  MediaInUse(Scene& scene) : scene_(scene) {}
  MediumId idOf(const MediumSpec& spec) {
    for (std::size_t i = 0; i < scene_.media.size(); ++i)
      if (scene_.media[i].name == spec.name) return MediumId(i);
    scene_.media.push_back(resolveMedium(spec, scene_.probe.frequency_hz));
    return MediumId(scene_.media.size() - 1);
  }

 private:
  Scene& scene_;
};

void readStructures(TomlTable& root, const MediaTable& table, MediaInUse& media,
                    const NamedMeshes* meshes, Scene& scene) {
  for (TomlTable& entry : root.tables("structure")) {
    Structure structure =
        readStructure(entry, scene.file.parent_path(), scene.motion.keyframe_phases, meshes);
    structure.medium = media.idOf(table.named(entry, "medium"));
    entry.finish();
    for (const Structure& other : scene.structures)
      if (other.name == structure.name)
        entry.fail("name",
                   fmt::format("\"{}\" is already used, accepted: a unique name", structure.name));
    scene.structures.push_back(std::move(structure));
    if (scene.structures.size() > kMaxSurfaces)
      entry.fail("name",
                 fmt::format("is one structure too many, accepted: up to {}", kMaxSurfaces));
  }
}

// Smooth kinds guess the way between keyframes from their neighbours, which takes several: below
// kSmoothKeyframes of the structure that has most, the volume curve knows better. Our choice.
constexpr std::size_t kSmoothKeyframes = 5;
Interpolation interpolationFor(const std::vector<Structure>& structures, Interpolation smooth) {
  std::size_t most = 0;
  for (const Structure& s : structures) most = std::max(most, s.keyframes.size());
  return most < kSmoothKeyframes ? Interpolation::cycle : smooth;
}

Scene parse(std::string_view text, const std::filesystem::path& file, const NamedMeshes* meshes) {
  TomlTable root = TomlTable::parse(text, file.string());
  Scene scene;
  scene.file = file;
  const MotionKeys motion = readMotion(root.table("motion"), scene);
  readProbe(root.table("probe"), scene);
  MediaTable media_table;
  media_table.read(root);
  MediaInUse media(scene);
  scene.background = media.idOf(media_table.named(root, "background", "soft_tissue"));
  readStructures(root, media_table, media, meshes, scene);
  if (scene.structures.empty())
    root.fail("structure", "is missing, accepted: at least one [[structure]]");
  const std::optional<double> spaced_hz = rateOfInterval(motion, scene.structures);
  if (spaced_hz) scene.motion.keyframe_heart_rate_hz = spaced_hz;
  readAcquisition(root.table("acquisition"), spaced_hz, scene);
  if (!scene.motion.interpolation_given)
    scene.motion.interpolation = interpolationFor(scene.structures, scene.motion.interpolation);
  readKeys(root, "", {&scene});
  readPlain(root.table("effects"), "effects", scene);
  takeLook(root.table("signal"), scene);
  for (const char* of_look : {"trabeculae", "leaflets", "speckle", "artefacts"})
    readPlain(root.table(of_look), of_look, scene);
  readSignal(root.table("signal"), scene);
  readAccuracy(root.table("accuracy"), scene);
  readOutput(root.table("output"), scene);
  readTruth(root.table("truth"), scene);
  root.finish();
  refuseContradictions(root, scene);
  for (std::string& warning : keyframeWarnings(scene)) scene.warnings.push_back(std::move(warning));
  // Without attenuation there is no received intensity: the default channel is the one that is
  // true.
  if (scene.effects.attenuation == Switch::off && !scene.output.channels_given)
    scene.output.channels = {Channel::unattenuated};
  return scene;
}

}  // namespace

Scene parseScene(std::string_view text, const std::filesystem::path& file) {
  return parse(text, file, nullptr);
}

Scene parseScene(std::string_view text, const std::filesystem::path& file,
                 const NamedMeshes& meshes) {
  return parse(text, file, &meshes);
}

Scene readScene(const std::filesystem::path& file) {
  return parseScene(readTextFile(file, kMaxSceneBytes), file);
}

}  // namespace echocine
