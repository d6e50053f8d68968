// The knobs of the surfaces that rays meet.

#include <fmt/format.h>

#include <algorithm>

#include "motion/keyframes/interpolation.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/names.h"
#include "study/knob_builder.h"

namespace echocine {

namespace {

// Limit over all structures at the finest level: a frame in flight takes about 200 bytes for each.
constexpr double kMostTriangles = 2e6;

void addSubdivision(const Scene& scene, std::size_t triangles, KnobBuilder& table) {
  const int written = scene.motion.subdivision;
  if (written == 0)
    return table.leaveOut("subdivision", "motion.subdivision = 0 uses the meshes as surfaces");
  const double finest = 4.0 * static_cast<double>(triangles);
  const bool finer = finest <= kMostTriangles && written < 8;
  if (!finer)
    table.leaveOut(fmt::format("subdivision {}", written + 1),
                   fmt::format("{:.0f} triangles, accepted: {:.0f}", finest, kMostTriangles));
  table.addNumbers("subdivision", "motion.subdivision", "Loop levels of the meshes",
                   {written - 1, written, written + (finer ? 1 : 0)}, {0, 1, 1, 2},
                   [](Scene& s, int n) { s.motion.subdivision = n; });
}

// Reason not to read the meshes of a scene; empty if there is none.
std::string refusal(const Scene& scene) {
  try {
    const MeshMotion motion(scene);
    return {};
  } catch (const SceneError& error) {
    return error.what();
  }
}

void addNormals(const Scene& scene, KnobBuilder& table) {
  if (scene.motion.subdivision == 0 && scene.accuracy.normals != Normals::smooth)
    return table.leaveOut("normals", "motion.subdivision = 0 uses the meshes as surfaces");
  Scene smooth = scene;
  smooth.accuracy.normals = Normals::smooth;
  const std::string refused = refusal(smooth);
  if (!refused.empty()) return table.leaveOut("normals", refused);
  table.add({"normals",
             "accuracy.normals",
             "angles of incidence from facets or the limit surface",
             {{"facet", [](Scene& s) { s.accuracy.normals = Normals::facet; }},
              {"smooth", [](Scene& s) { s.accuracy.normals = Normals::smooth; }}},
             {0, 0, 1, 1}});
}

std::vector<Keyframe> everyNth(const std::vector<Keyframe>& keyframes, std::size_t n) {
  std::vector<Keyframe> kept;
  for (std::size_t i = 0; i < keyframes.size(); i += n) kept.push_back(keyframes[i]);
  return kept;
}

void addKeyframes(const Scene& scene, KnobBuilder& table) {
  std::size_t most = 0;
  for (const Structure& s : scene.structures) most = std::max(most, s.keyframes.size());
  Knob knob{"keyframes", "structure.keyframes", "keyframes used, all or every n-th", {}, {}};
  for (const std::size_t n : {4, 2, 1}) {
    if (n > 1 && most < 3 * n) continue;  // fewer than three keyframes are no motion
    knob.values.push_back({n == 1 ? "all" : fmt::format("1/{}", n), [n](Scene& s) {
                             for (Structure& structure : s.structures)
                               structure.keyframes = everyNth(structure.keyframes, n);
                           }});
  }
  knob.of_preset.fill(knob.values.size() - 1);  // leaving some out saves no time
  table.add(std::move(knob));
}

bool accepts(const Scene& scene, Interpolation kind) {
  try {
    for (const Structure& structure : scene.structures) {
      std::vector<double> phases;
      for (const Keyframe& keyframe : structure.keyframes) phases.push_back(keyframe.phase);
      const KeyframeWeights weights(phases, kind);
    }
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

void addInterpolation(const Scene& scene, KnobBuilder& table) {
  if (std::all_of(scene.structures.begin(), scene.structures.end(),
                  [](const Structure& s) { return s.keyframes.size() == 1; }))
    return table.leaveOut("interpolation", "nothing moves");
  Knob knob{"interpolation",
            "motion.interpolation",
            "between keyframes; the scene's own is the reference",
            {},
            {}};
  using Kind = Named<Interpolation>;
  const auto value = [](const Kind& k) {
    return KnobValue{k.name, [kind = k.value](Scene& s) { s.motion.interpolation = kind; }};
  };
  for (const Kind& k : NamesOf<Interpolation>::kAll) {
    if (k.value == scene.motion.interpolation) continue;
    if (accepts(scene, k.value))
      knob.values.push_back(value(k));
    else
      table.leaveOut(fmt::format("interpolation {}", k.name),
                     "would overshoot between keyframes this uneven");
  }
  for (const Kind& k : NamesOf<Interpolation>::kAll)
    if (k.value == scene.motion.interpolation) knob.values.push_back(value(k));
  knob.of_preset.fill(knob.values.size() - 1);  // what is true between keyframes is the scene's say
  table.add(std::move(knob));
}

}  // namespace

void addMotionKnobs(const Scene& scene, std::size_t triangles, KnobBuilder& table) {
  addSubdivision(scene, triangles, table);
  addNormals(scene, table);
  addKeyframes(scene, table);
  addInterpolation(scene, table);
}

}  // namespace echocine
