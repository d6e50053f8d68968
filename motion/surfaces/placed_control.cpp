#include "motion/surfaces/placed_control.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"
#include "motion/mesh/world_place.h"

namespace echocine {

namespace {

// Single precision is good to a micrometre within this distance of the probe. Our choice.
constexpr double kMaxDistanceMetres = 10;

std::vector<double> phasesOf(const Structure& structure) {
  std::vector<double> phases;
  for (const Keyframe& keyframe : structure.keyframes) phases.push_back(keyframe.phase);
  return phases;
}

// The beat of the keyframes. If there are two, one is at the R wave and the other has the smallest
// volume, as in segmentations of two phases.
HeartPace paceOf(const Scene& scene, const Structure& structure) {
  RecordedBeat beat{scene.motion.keyframe_heart_rate_hz.value_or(scene.acquisition.heart_rate_hz),
                    scene.motion.end_systole_phase};
  const std::vector<Keyframe>& keyframes = structure.keyframes;
  if (!beat.end_systole_phase && keyframes.size() == 2 && keyframes[0].phase == 0)
    beat.end_systole_phase = endSystoleAround(keyframes[1].phase, beat.heart_rate_hz);
  return HeartPace(beat);
}

// Mesh units in the world -> metres in the probe frame, in double until the apex is the origin.
std::vector<Vec3d> probePositions(const Structure& structure, const KeyframeMesh& keyframe,
                                  const Scene& scene) {
  std::vector<Vec3d> positions_m;
  positions_m.reserve(keyframe.mesh.positions.size());
  for (const Vec3d& world : keyframe.mesh.positions) {
    const Vec3d p = scene.probe.pose.fromWorld(worldPlace(scene.motion, world));
    if (!(length(p) <= kMaxDistanceMetres))
      throw SceneError(atPlace(
          structure.place,
          fmt::format("{}: {} reaches {:.4g} m from the probe's apex, at most {:g} m is accepted: "
                      "correct motion.mesh_unit, motion.mesh_scale or the probe's position",
                      structure.name, keyframe.parts.front().file.string(), length(p),
                      kMaxDistanceMetres)));
    positions_m.push_back(p);
  }
  return positions_m;
}

// To single precision. A coordinate within rounding (a picometre) of a coordinate plane becomes
// exactly 0, so vertices that a mesh puts on the imaging plane stay there after the rotation into
// the probe frame.
std::vector<Vec3f> narrowed(const std::vector<Vec3d>& values) {
  const auto onPlane = [](double c) { return std::abs(c) < 1e-12 ? 0.0 : c; };
  std::vector<Vec3f> floats(values.size());
  std::transform(values.begin(), values.end(), floats.begin(), [&](Vec3d v) {
    return toFloat({onPlane(v.x), onPlane(v.y), onPlane(v.z)});
  });
  return floats;
}

std::vector<Vec3d> weightedSum(std::span<const double> weights,
                               const std::vector<std::vector<Vec3d>>& keyframes) {
  std::vector<Vec3d> sum(keyframes.front().size());
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    for (std::size_t v = 0; v < sum.size(); ++v) sum[v] = sum[v] + weights[k] * keyframes[k][v];
  return sum;
}

Box loopBox(const std::vector<std::vector<Vec3d>>& keyframes_m, double overshoot, double aside_m) {
  Box box;
  for (const std::vector<Vec3d>& positions : keyframes_m)
    for (const Vec3d& p : positions) box.add(p);
  const Vec3d widen = overshoot * (box.hi - box.lo) + aside_m * Vec3d{1, 1, 1};
  return {box.lo - widen, box.hi + widen};
}

ControlMotion controlMotion(KeyframeWeights weights, const SurfaceTopology& topology,
                            const std::vector<KeyframeMesh>& keyframes,
                            const std::vector<std::vector<Vec3d>>& positions_m) {
  ControlMotion control{std::move(weights), topology.triangles, {}, {}, topology.membrane};
  for (const KeyframeMesh& keyframe : keyframes) control.parts.push_back(keyframe.parts);
  for (const std::vector<Vec3d>& positions : positions_m)
    control.rows_m.push_back(narrowed(positions));
  for (std::size_t row = keyframes.size(); row < control.weights.rowCount(); ++row)
    control.rows_m.push_back(narrowed(weightedSum(control.weights.rowWeights(row), positions_m)));
  return control;
}

}  // namespace

ControlMotion placedControl(const std::vector<KeyframeMesh>& keyframes, const Scene& scene,
                            const Structure& structure, const SurfaceTopology& topology,
                            double aside_m, Box& loop_box_m) {
  KeyframeWeights weights(phasesOf(structure), scene.motion.interpolation, structure.place,
                          paceOf(scene, structure));
  std::vector<std::vector<Vec3d>> positions_m;
  positions_m.reserve(keyframes.size());
  for (const KeyframeMesh& keyframe : keyframes)
    positions_m.push_back(probePositions(structure, keyframe, scene));
  loop_box_m = loopBox(positions_m, weights.overshoot(), aside_m);
  return controlMotion(std::move(weights), topology, keyframes, positions_m);
}

}  // namespace echocine
