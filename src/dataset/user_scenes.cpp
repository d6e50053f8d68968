#include "dataset/user_scenes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/file.h"
#include "motion/surfaces/keyframe_set.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/names.h"
#include "scene/role.h"
#include "scene/scene_reader.h"

namespace echocine::dataset {

namespace {

constexpr std::size_t kMostSceneBytes = std::size_t{16} << 20;

// Reports the error of a scene's own reader at the spec's key.
[[noreturn]] void failOfScenes(const Spec& spec, const std::string& what) {
  throw SceneError(atPlace({spec.file.string(), 0, "scenes"}, what));
}

// Truth is of the left ventricle.
void checkRoles(const Spec& spec, const UserScene& mine, const Scene& scene) {
  const bool needs_wall = spec.wantsTracks() || spec.wants("function");
  for (const Role role : {Role::lv_cavity, Role::lv_wall})
    if (!structureOf(scene, role) && (role == Role::lv_cavity || needs_wall))
      failOfScenes(spec,
                   fmt::format("{} has no structure with role = \"{}\", which the truth needs",
                               mine.name, nameOf(role)));
}

ViewPlacement standardView(const Spec& spec, View view) {
  ViewPlacement placement;
  placement.view = view;
  placement.place = {spec.file.string(), 0, "views"};
  return placement;
}

}  // namespace

void readUserScenes(TomlTable& file, Spec& spec, Sha256& digest) {
  if (!file.has("scenes")) return;
  for (const char* heart : {"heart", "populations", "population", "keyframes"})
    if (file.has(heart))
      file.fail(
          heart,
          "is for the parametric heart, but scenes define their own hearts: omit one of the two");
  for (const std::string& name : file.texts("scenes")) {
    const bool twice = std::any_of(spec.scenes.begin(), spec.scenes.end(),
                                   [&](const UserScene& s) { return s.name == name; });
    if (twice) file.fail("scenes", fmt::format("names \"{}\" twice, accepted: once", name));
    UserScene mine{name, spec.file.parent_path() / name, {}, {}};
    try {
      mine.text = readTextFile(mine.file, kMostSceneBytes);
      const Scene scene = parseScene(mine.text, mine.file);
      checkRoles(spec, mine, scene);
      mine.acquisition = scene.acquisition;
      digest.update(name);
      digest.update(withValues(mine.text, name, {}));
      digest.update(readKeyframes(scene).sha256);
    } catch (const SceneError& error) {
      file.fail("scenes", error.what());
    }
    spec.scenes.push_back(std::move(mine));
  }
  if (spec.scenes.empty()) file.fail("scenes", "is empty, accepted: names of scene files");
  for (const UserScene& mine : spec.scenes)
    spec.populations.push_back({mine.name, 1.0 / static_cast<double>(spec.scenes.size()), {}});
}

void checkUserScenes(const Spec& spec) {
  for (const Parameter& p : spec.parameters)
    for (const char* key : {"view", "shift_mm", "tilt_deg", "rotate_deg"})
      if (!spec.scenes.empty() && p.name == fmt::format("scene.probe.{}", key))
        throw SceneError(
            atPlace(p.place, "cannot be set with scenes, accepted: views and [offset]"));
  for (const UserScene& mine : spec.scenes) {
    const Scene scene = parseScene(mine.text, mine.file);
    for (const View view : spec.views) {
      Scene aimed = scene;
      aimed.view = standardView(spec, view);
      try {
        placed(std::move(aimed));
      } catch (const SceneError& error) {
        failOfScenes(spec, fmt::format("{}: {}", mine.name, error.what()));
      }
    }
  }
}

Scene userScene(const Spec& spec, const Draw& draw, View view,
                const std::vector<std::pair<std::string, TomlValue>>& values) {
  const UserScene& mine = spec.sceneOf(draw.heart);
  Scene scene = parseScene(withValues(mine.text, mine.file.string(), values), mine.file);
  scene.view = standardView(spec, view);
  return placed(std::move(scene));
}

}  // namespace echocine::dataset
