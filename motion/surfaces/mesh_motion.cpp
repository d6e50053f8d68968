#include "motion/surfaces/mesh_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/check.h"
#include "core/error.h"
#include "core/stop.h"
#include "motion/keyframes/interpolation.h"
#include "motion/mesh/surface_measure.h"
#include "motion/mesh/world_place.h"
#include "motion/subdivision/limit_normals.h"
#include "motion/subdivision/shared_subdivision.h"
#include "motion/surfaces/near_plane.h"
#include "plan/effect_plan.h"
#include "scene/elevation_slices.h"
#include "scene/role.h"

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

// A frame with left-handed axes mirrors space, which inverts every face.
bool mirrors(const Pose& pose) {
  return dot(cross(pose.x_axis, pose.y_axis), pose.z_axis) < 0;
}

SurfaceTopology controlTopology(const Structure& structure, SurfaceId id, const TriangleMesh& mesh,
                                const Pose& pose) {
  SurfaceTopology topology{id, mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()),
                           structure.membrane, structure.keyframes.size() == 1};
  if (mirrors(pose))
    for (Triangle& t : topology.triangles) std::swap(t[1], t[2]);
  return topology;
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

struct MeshMotion::MovingSurface {
  ControlMotion control;
  std::shared_ptr<const Subdivision> subdivision{};
  std::shared_ptr<const LimitNormals> limit_normals{};
  std::vector<Vec3f> still_m{};  // of a static structure with subdivision: the refined vertices
  double still_volume_m3 = 0;    // of a static structure
  VolumeSum volume{};            // of any other closed one

  void smooth(SurfaceTopology& topology, const MeshTags& tags, const Scene& scene);
  void subdivide(SurfaceTopology& topology, const MeshTags& tags, const MotionSettings& motion);
  void frameAt(double phase, std::vector<Vec3f>& positions_m, std::vector<Vec3f>* normals) const;
  std::vector<NumberedTriangle> nearPlane(const SurfaceTopology& topology, double aside_m) const;
};

void MeshMotion::MovingSurface::frameAt(double phase, std::vector<Vec3f>& positions_m,
                                        std::vector<Vec3f>* normals) const {
  if (!still_m.empty()) {
    positions_m = still_m;
    return;
  }
  if (!subdivision && !limit_normals) return control.at(phase, positions_m);
  thread_local std::vector<Vec3f> control_m;
  control.at(phase, control_m);
  if (limit_normals && normals) {
    normals->resize(limit_normals->normalCount());
    limit_normals->apply(control_m, *normals);
  }
  if (!subdivision) {
    positions_m = control_m;
    return;
  }
  positions_m.resize(subdivision->vertexCount());
  subdivision->apply(control_m, positions_m);
}

std::vector<NumberedTriangle> MeshMotion::MovingSurface::nearPlane(const SurfaceTopology& topology,
                                                                   double aside_m) const {
  HeightRanges heights;
  for (std::size_t k = 0; k < control.weights.keyframeCount(); ++k) heights.add(control.rows_m[k]);
  if (subdivision) heights.refine(*subdivision);
  return heights.nearPlane(topology.triangles, control.weights.overshoot(), aside_m);
}

// Normals of the limit surface at the vertices of subdivide().
void MeshMotion::MovingSurface::smooth(SurfaceTopology& topology, const MeshTags& tags,
                                       const Scene& scene) {
  limit_normals = sharedLimitNormals(topology.triangles, topology.vertex_count, tags,
                                     scene.motion.subdivision, scene.accuracy.normals_place);
  topology.normal_corners = limit_normals->corners();
}

// Refines the topology now, and positions in every frame.
void MeshMotion::MovingSurface::subdivide(SurfaceTopology& topology, const MeshTags& tags,
                                          const MotionSettings& motion) {
  subdivision = sharedSubdivision(topology.triangles, topology.vertex_count, tags,
                                  motion.subdivision, motion.subdivision_place);
  topology.triangles = subdivision->triangles();
  topology.vertex_count = subdivision->vertexCount();
  if (!control.still() || limit_normals) return;
  // For a static structure also the positions; its normals need the control vertices.
  still_m.resize(subdivision->vertexCount());
  subdivision->apply(control.rows_m.front(), still_m);
  subdivision.reset();
}

namespace {

// Facets scatter refracted rays, so these use smooth normals by default. Meshes without subdivision
// have none.
bool smoothNormalsOf(const Scene& scene) {
  if (scene.accuracy.normals != Normals::automatic)
    return scene.accuracy.normals == Normals::smooth;
  if (scene.media.empty()) return false;  // no media: rays cannot bend
  return scene.motion.subdivision > 0 && scene.accuracy.tracer != TracerChoice::slice &&
         planEffects(scene).refraction;
}

}  // namespace

// Unless requested, all surfaces use facet normals if one has no smooth normals.
void MeshMotion::offerNormals(MovingSurface& moving, SurfaceTopology& topology,
                              const MeshTags& tags, const Scene& scene) {
  try {
    moving.smooth(topology, tags, scene);
  } catch (const SceneError&) {
    if (scene.accuracy.normals == Normals::smooth) throw;
    smooth_normals_ = false;
  }
}

MeshMotion::MeshMotion(const Scene& scene) : MeshMotion(readKeyframes(scene), scene) {}

MeshMotion::MeshMotion(const KeyframeSet& set, const Scene& scene)
    : repair_notes_(set.repair_notes),
      smooth_normals_(smoothNormalsOf(scene)),
      input_sha256_(set.sha256) {
  CHECK_EQ(set.structures.size(), scene.structures.size());
  if (scene.view)
    throw SceneError(atPlace(scene.view->place,
                             "is not computed yet, accepted: the scene that placed() returns"));
  const double slices_m = elevationReach(scene);
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    checkpoint();
    const Structure& structure = scene.structures[s];
    KeyframeWeights weights(phasesOf(structure), scene.motion.interpolation, structure.place,
                            paceOf(scene, structure));
    const std::vector<KeyframeMesh>& keyframes = set.structures[s];
    SurfaceTopology topology = controlTopology(structure, static_cast<SurfaceId>(s),
                                               keyframes.front().mesh, scene.probe.pose);
    std::vector<std::vector<Vec3d>> positions_m;
    positions_m.reserve(keyframes.size());
    for (const KeyframeMesh& keyframe : keyframes)
      positions_m.push_back(probePositions(structure, keyframe, scene));
    const double aside_m = trabeculaeReach(scene, structure) + slices_m;
    loop_boxes_m_.push_back(loopBox(positions_m, weights.overshoot(), aside_m));
    MovingSurface moving{controlMotion(std::move(weights), topology, keyframes, positions_m)};
    const MeshTags& tags = keyframes.front().mesh.tags;
    if (smooth_normals_) offerNormals(moving, topology, tags, scene);
    if (scene.motion.subdivision > 0) moving.subdivide(topology, tags, scene.motion);
    if (topology.still) {
      std::vector<Vec3f> still_m, normals;
      moving.frameAt(0, still_m, &normals);
      moving.still_volume_m3 = enclosedVolume(topology, still_m);
    } else if (!topology.membrane) {
      moving.volume = VolumeSum(topology.triangles);
    }
    if (!topology.still) topology.near_plane = moving.nearPlane(topology, aside_m);
    surfaces_.push_back(std::move(topology));
    moving_.push_back(std::move(moving));
  }
}

MeshMotion::~MeshMotion() = default;
MeshMotion::MeshMotion(MeshMotion&&) noexcept = default;

const ControlMotion& MeshMotion::control(SurfaceId id) const {
  return moving_[index(id)].control;
}

void MeshMotion::frameAt(double phase, SurfaceFrame& frame, bool normals) const {
  normals = normals && smooth_normals_;
  frame.positions_m.resize(moving_.size());
  frame.normals.resize(normals ? moving_.size() : 0);
  for (std::size_t s = 0; s < moving_.size(); ++s) {
    checkpoint();
    const bool in_place = surfaces_[s].still && !frame.positions_m[s].empty() &&
                          (!normals || !frame.normals[s].empty());
    if (!in_place)
      moving_[s].frameAt(phase, frame.positions_m[s], normals ? &frame.normals[s] : nullptr);
  }
}

double MeshMotion::volumeIn(const SurfaceFrame& frame, const SurfaceTopology& surface) const {
  const std::size_t s = index(surface.id);
  return surface.still ? moving_[s].still_volume_m3 : moving_[s].volume.of(frame.positions_m[s]);
}

double enclosedVolume(const SurfaceTopology& surface, const std::vector<Vec3f>& positions_m) {
  if (surface.membrane || surface.triangles.empty()) return 0;
  CHECK_EQ(positions_m.size(), surface.vertex_count);
  return enclosedVolume(surface.triangles, positions_m);
}

}  // namespace echocine
