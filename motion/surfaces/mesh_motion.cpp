#include "motion/surfaces/mesh_motion.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <numeric>
#include <optional>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "motion/mesh/surface_measure.h"
#include "motion/subdivision/limit_normals.h"
#include "motion/subdivision/shared_subdivision.h"
#include "motion/surfaces/near_plane.h"
#include "motion/surfaces/placed_control.h"
#include "plan/effect_plan.h"
#include "scene/elevation_slices.h"
#include "scene/role.h"

namespace echocine {

namespace {

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

}  // namespace

struct MeshMotion::MovingSurface {
  explicit MovingSurface(ControlMotion placed) : control(std::move(placed)) {}

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

// One structure, prepared by one thread.
struct MeshMotion::Prepared {
  SurfaceTopology topology;
  Box loop_box_m;
  MovingSurface moving;
  bool unsmooth = false;  // smooth normals are wanted but impossible here

  Prepared(const std::vector<KeyframeMesh>& keyframes, const Scene& scene,
           const Structure& structure, SurfaceId id, double aside_m)
      : topology(controlTopology(structure, id, keyframes.front().mesh, scene.probe.pose)),
        moving(placedControl(keyframes, scene, structure, topology, aside_m, loop_box_m)) {}
  void smooth(const MeshTags& tags, const Scene& scene);
  void subdivide(const MeshTags& tags, const Scene& scene, double aside_m);
};

void MeshMotion::Prepared::smooth(const MeshTags& tags, const Scene& scene) {
  try {
    moving.smooth(topology, tags, scene);
  } catch (const SceneError&) {
    if (scene.accuracy.normals == Normals::smooth) throw;
    unsmooth = true;
  }
}

void MeshMotion::Prepared::subdivide(const MeshTags& tags, const Scene& scene, double aside_m) {
  if (scene.motion.subdivision > 0) moving.subdivide(topology, tags, scene.motion);
  if (topology.still) {
    std::vector<Vec3f> still_m, normals;
    moving.frameAt(0, still_m, &normals);
    moving.still_volume_m3 = enclosedVolume(topology, still_m);
  } else if (!topology.membrane) {
    moving.volume = VolumeSum(topology.triangles);
  }
  if (!topology.still) topology.near_plane = moving.nearPlane(topology, aside_m);
}

namespace {

// Structures by descending size, so that none is left to a single thread at the end.
std::vector<std::size_t> largestFirst(const KeyframeSet& set) {
  std::vector<std::size_t> order(set.structures.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return set.structures[a].front().mesh.triangles.size() >
           set.structures[b].front().mesh.triangles.size();
  });
  return order;
}

}  // namespace

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
  // In parallel, with the first error in the scene's order for any number of threads.
  const std::size_t count = scene.structures.size();
  std::vector<std::optional<Prepared>> prepared(count);
  std::vector<std::exception_ptr> refusals(count);
  const std::vector<std::size_t> order = largestFirst(set);
  parallelBlocks(count, 1, [&](std::size_t i, std::size_t) {
    const std::size_t s = order[i];
    try {
      const Structure& structure = scene.structures[s];
      // Relief and the body of a leaflet stand out of the mesh, so they may reach the plane.
      const double aside_m =
          trabeculaeReach(scene, structure) + leafletThickness(scene, structure) + slices_m;
      const MeshTags& tags = set.structures[s].front().mesh.tags;
      prepared[s].emplace(set.structures[s], scene, structure, static_cast<SurfaceId>(s), aside_m);
      if (smooth_normals_) prepared[s]->smooth(tags, scene);
      prepared[s]->subdivide(tags, scene, aside_m);
    } catch (const SceneError&) {
      refusals[s] = std::current_exception();
    }
  });
  for (std::size_t s = 0; s < count; ++s) {
    if (refusals[s]) std::rethrow_exception(refusals[s]);
    // Unless requested, all surfaces use facet normals if one has no smooth normals.
    if (prepared[s]->unsmooth) smooth_normals_ = false;
    loop_boxes_m_.push_back(prepared[s]->loop_box_m);
    surfaces_.push_back(std::move(prepared[s]->topology));
    moving_.push_back(std::move(prepared[s]->moving));
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

void MeshMotion::positionsAt(double phase, std::span<const SurfaceId> some,
                             SurfaceFrame& frame) const {
  frame.positions_m.resize(moving_.size());
  for (const SurfaceId surface : some) {
    checkpoint();
    const std::size_t s = index(surface);
    if (!surfaces_[s].still || frame.positions_m[s].empty())
      moving_[s].frameAt(phase, frame.positions_m[s], nullptr);
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
