#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dataset/spec.h"
#include "dataset/user_scenes.h"
#include "motion/heart/parameters.h"
#include "scene/scene_reader.h"

namespace echocine::dataset {

namespace {

// The least scene, in which every key can be tried before a heart is made.
constexpr const char* kTrialScene = R"(background = "soft_tissue"
[probe]
kind = "phased"
apex = [0, 0, 0]
axis = [0, 0, 1]
lateral = [1, 0, 0]
sector_deg = 75
min_depth_mm = 2
depth_mm = 160
frequency_mhz = 2.5
lines = 256
samples = 1024
[motion]
mesh_unit = "mm"
[signal]
look = "scanner"
reference_intensity = 4e-4
[[structure]]
name = "lv_cavity"
medium = "blood"
keyframes = "one.obj"
)";

NamedMeshes trialMesh() {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{0, 0, 50}, {10, 0, 50}, {0, 10, 50}, {0, 0, 60}};
  mesh->triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return {{"one.obj", mesh}};
}

// The ends of what it gives; each word of a choice.
std::vector<TomlValue> extremes(const Distribution& d) {
  if (!d.items.empty()) return d.items;
  constexpr double kEnd = 1e-12;
  return {d.quantile(kEnd), d.quantile(1 - kEnd)};
}

// A scene in which keys are tried.
struct TrialScene {
  std::string text;
  std::filesystem::path file;
  NamedMeshes meshes;

  void read(const std::vector<std::pair<std::string, TomlValue>>& values) const {
    const std::string changed = withValues(text, file.string(), values);
    if (meshes.empty())
      parseScene(changed, file);
    else
      parseScene(changed, file, meshes);
  }
};

// Every scene key at each of its extremes, the others in their middle.
void tryKeys(const Spec& spec, const TrialScene& trial) {
  std::vector<std::pair<std::string, TomlValue>> middle;
  std::vector<const Parameter*> tried;
  for (const Parameter& p : spec.parameters) {
    if (!p.name.starts_with("scene.")) continue;
    middle.emplace_back(p.name.substr(6), p.distribution.quantile(0.5));
    tried.push_back(&p);
  }
  for (std::size_t i = 0; i < tried.size(); ++i) {
    auto values = middle;
    for (const TomlValue& value : extremes(tried[i]->distribution)) {
      values[i].second = value;
      try {
        trial.read(values);
      } catch (const SceneError& error) {
        throw SceneError(atPlace(tried[i]->place, fmt::format("with {} a scene is refused: {}",
                                                              tomlText(value), error.what())));
      }
    }
  }
}

void tryScenes(const Spec& spec) {
  if (spec.scenes.empty()) tryKeys(spec, {kTrialScene, "scene", trialMesh()});
  for (const UserScene& mine : spec.scenes) tryKeys(spec, {mine.text, mine.file, {}});
}

[[noreturn]] void failOfLayouts(const Spec& spec, const std::string& what) {
  throw SceneError(atPlace({spec.file.string(), 0, "layouts"}, what));
}

bool isApical(View view) {
  return view == View::a4c || view == View::a2c || view == View::a3c;
}

// The most or the least that a parameter of a population gives; `otherwise` where it is not drawn.
double endOf(const std::vector<Parameter>& parameters, const std::string& name, bool most,
             double otherwise) {
  for (const Parameter& p : parameters)
    if (p.name == name)
      if (const auto range = p.distribution.range()) return most ? range->second : range->first;
  return otherwise;
}

// Frames of the fastest heart at the lowest frame rate, in beats that do not vary.
void checkFrames(const Spec& spec) {
  for (std::size_t i = 0; i < spec.populations.size(); ++i) {
    const Population& population = spec.populations[i];
    const bool own = !spec.scenes.empty();
    const Acquisition usual = own ? spec.scenes[i].acquisition : Acquisition{};
    const std::vector<Parameter> all = spec.parametersOf(population);
    const double heart_bpm = own ? 60 * usual.heart_rate_hz
                                 : endOf(all, "heart.hr", true, heart::Parameters{}.heart_rate_bpm);
    const double bpm = endOf(all, "scene.acquisition.heart_rate_bpm", true, heart_bpm),
                 fps = endOf(all, "scene.acquisition.frame_rate_hz", false, usual.frame_rate_hz),
                 beats = endOf(all, "scene.acquisition.beats", false, usual.beats);
    const long frames = std::lround(beats * fps * 60 / bpm);
    if (frames < kLeastTrackedFrames)
      failOfLayouts(spec,
                    fmt::format("\"myotracker\" needs {} frames, but a loop of \"{}\" may have "
                                "{}: {:g} beats at {:g} frames/s and {:g} beats/min; raise "
                                "scene.acquisition.frame_rate_hz or beats",
                                kLeastTrackedFrames, population.name, frames, beats, fps, bpm));
  }
}

void checkLayouts(const Spec& spec) {
  if (spec.has("myotracker")) checkFrames(spec);
  const auto shows = [&](View view) {
    return std::find(spec.views.begin(), spec.views.end(), view) != spec.views.end();
  };
  if (spec.has("camus") && !(spec.views.size() == 2 && shows(View::a2c) && shows(View::a4c)))
    failOfLayouts(spec,
                  "\"camus\" holds two views of each heart, accepted: views = [\"a2c\", \"a4c\"]");
  if (spec.has("camus") && spec.hearts > 9999)
    failOfLayouts(spec, fmt::format("\"camus\" numbers patients by four digits, but hearts is {}, "
                                    "accepted: up to 9999",
                                    spec.hearts));
  if (spec.has("webdataset") && !spec.has("native"))
    failOfLayouts(spec, "\"webdataset\" packs what \"native\" writes, accepted: both");
  if (spec.has("echonet") && !std::all_of(spec.views.begin(), spec.views.end(), isApical))
    failOfLayouts(spec, "\"echonet\" traces the long axis, accepted: views a4c, a2c and a3c");
}

}  // namespace

void checkSpec(const Spec& spec) {
  checkUserScenes(spec);
  tryScenes(spec);
  checkLayouts(spec);
}

}  // namespace echocine::dataset
