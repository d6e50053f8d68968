#include "scene/scene_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/file.h"
#include "core/units.h"
#include "scene/contradictions.h"
#include "scene/elevation_slices.h"
#include "scene/keyframe_warnings.h"
#include "scene/media_reader.h"
#include "scene/motion_reader.h"
#include "scene/probe_reader.h"
#include "scene/ranges.h"
#include "scene/signal_reader.h"
#include "scene/structure_reader.h"
#include "scene/tolerance_reader.h"
#include "scene/toml_table.h"
#include "scene/truth_reader.h"

namespace echocine {

namespace {

constexpr std::size_t kMaxSceneBytes = 4 << 20;
constexpr double kMaxFrames = 1e6;
// Our choice: three deviations of it leave a tenth of the mean beat.
constexpr double kMaxRrVariability = 0.3;
constexpr int kMaxRaysPerBeam = 4096;  // errors are then far under a picture's. Our choice

// keyframe_rate_hz: of the loop where it names no heart rate of its own.
Acquisition readAcquisition(TomlTable table, std::optional<double> keyframe_rate_hz) {
  Acquisition a;
  a.heart_rate_hz = keyframe_rate_hz.value_or(a.heart_rate_hz);
  if (!keyframe_rate_hz || table.has("heart_rate_bpm"))
    a.heart_rate_hz = hertzFromBeatsPerMinute(
        table.number("heart_rate_bpm", a.heart_rate_hz * 60, ranges::kHeartRates_bpm));
  a.frame_rate_hz = table.number("frame_rate_hz", a.frame_rate_hz, {.lo = 0.1, .hi = 100000});
  a.beats = table.number("beats", a.beats, ranges::kBeats);
  if (a.beats / a.heart_rate_hz * a.frame_rate_hz > kMaxFrames)
    table.fail("beats", fmt::format("the loop would have over {} frames", kMaxFrames));
  a.time_warp = table.choice("time_warp", a.time_warp);
  a.rr_variability =
      table.number("rr_variability", a.rr_variability, {.lo = 0, .hi = kMaxRrVariability});
  a.seed = table.integer("seed", a.seed, 0, std::numeric_limits<int>::max());
  a.rolling = table.boolean("rolling", a.rolling);
  a.rolling_share = table.number("rolling_share", a.rolling_share, ranges::kRollingShare);
  table.finish();
  return a;
}

EffectSwitches readEffects(TomlTable table) {
  EffectSwitches switches;
  for (const EffectSwitch& s : kEffectSwitches)
    switches.*s.wanted = table.choice(nameOf(s.effect), switches.*s.wanted);
  table.finish();
  return switches;
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

OutputSettings readOutput(TomlTable table) {
  OutputSettings o;
  o.exr = table.boolean("exr", o.exr);
  o.cine = table.boolean("cine", o.cine);
  o.png = table.boolean("png", o.png);
  o.report = table.boolean("report", o.report);
  o.channels_given = table.has("channels");
  if (o.channels_given) o.channels = readChannels(table);
  if (o.channels.empty()) table.fail("channels", "is empty, accepted: at least one channel");
  o.exr_compression = table.choice("exr_compression", o.exr_compression);
  o.exr_pixel = table.choice("exr_pixel", o.exr_pixel);
  o.codec = table.choice("codec", o.codec);
  o.jpeg_quality = table.integer("jpeg_quality", o.jpeg_quality, 1, 100);
  o.width = table.integer("width", o.width, 16, 16384);
  o.height = table.integer("height", o.height, 16, 16384);
  o.ecg = table.boolean("ecg", o.ecg);
  o.depth_ticks = table.boolean("depth_ticks", o.depth_ticks);
  table.finish();
  return o;
}

std::optional<SceneTolerance> readTolerance(TomlTable& table) {
  constexpr std::string_view kKey = "tolerance_db";
  if (!table.has(kKey)) return std::nullopt;
  return SceneTolerance{table.number(kKey, std::nullopt, ranges::kTolerance_db), table.place(kKey)};
}

AccuracySettings readAccuracy(TomlTable table, const AccuracySettings& defaults) {
  AccuracySettings a = defaults;
  a.rays_per_beam = table.integer("rays_per_beam", a.rays_per_beam, 1, kMaxRaysPerBeam);
  a.elevation_slices =
      table.integer("elevation_slices", a.elevation_slices, 1, kMostElevationSlices);
  if (a.elevation_slices % 2 == 0)
    table.fail("elevation_slices", fmt::format("is {}, accepted: 1, 3 or 5", a.elevation_slices));
  a.tracer = table.choice("tracer", a.tracer);
  a.interface_echo = table.choice("interface_echo", a.interface_echo);
  a.normals = table.choice("normals", a.normals);
  a.normals_place = table.place("normals");
  a.refraction_tolerance_beam_widths =
      table.number("refraction_tolerance_beam_widths", a.refraction_tolerance_beam_widths,
                   ranges::kToleranceLines);
  a.rolling_lines = table.integer("rolling_lines", a.rolling_lines, 1, ranges::kMostLines);
  readTolerance(table);  // who sets the accuracy; the scene as rendered has none
  table.finish();
  return a;
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
                   fmt::format("\"{}\" is taken, accepted: a name of its own", structure.name));
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
  const MotionKeys motion = readMotion(root.table("motion"));
  scene.motion = motion.settings;
  scene.probe = readProbe(root.table("probe"), scene.motion.mesh_unit_m, scene.view);
  MediaTable media_table;
  media_table.read(root);
  MediaInUse media(scene);
  scene.background = media.idOf(media_table.named(root, "background", "soft_tissue"));
  readStructures(root, media_table, media, meshes, scene);
  if (scene.structures.empty())
    root.fail("structure", "is missing, accepted: at least one [[structure]]");
  const std::optional<double> spaced_hz = rateOfInterval(motion, scene.structures);
  if (spaced_hz) scene.motion.keyframe_heart_rate_hz = spaced_hz;
  scene.acquisition = readAcquisition(root.table("acquisition"), spaced_hz);
  if (!scene.motion.interpolation_given)
    scene.motion.interpolation = interpolationFor(scene.structures, scene.motion.interpolation);
  scene.unit_volume_m3 =
      cubicMetresFromCubicCentimetres(root.number("unit_volume_cm3", 1.0, ranges::kUnitVolume_cm3));
  scene.effects = readEffects(root.table("effects"));
  takeLook(root.table("signal"), scene);
  scene.trabeculae = readTrabeculae(root.table("trabeculae"), scene.trabeculae);
  scene.speckle = readSpeckle(root.table("speckle"), scene.speckle);
  scene.artefacts = readArtefacts(root.table("artefacts"), scene.artefacts);
  scene.signal = readSignal(root.table("signal"), scene.signal);
  scene.accuracy = readAccuracy(root.table("accuracy"), scene.accuracy);
  scene.output = readOutput(root.table("output"));
  if (root.has("truth")) scene.truth = readTruth(root.table("truth"), scene);
  root.finish();
  refuseContradictions(root, scene);
  scene.warnings = keyframeWarnings(scene);
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

std::optional<SceneTolerance> readSceneTolerance(const std::filesystem::path& file) {
  TomlTable root = TomlTable::parse(readTextFile(file, kMaxSceneBytes), file.string());
  TomlTable accuracy = root.table("accuracy");
  return readTolerance(accuracy);
}

Scene readScene(const std::filesystem::path& file) {
  return parseScene(readTextFile(file, kMaxSceneBytes), file);
}

}  // namespace echocine
