#include "motion/heart_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/check.h"
#include "core/error.h"
#include "core/hash.h"
#include "motion/interpolation.h"
#include "motion/mesh_check.h"
#include "motion/mesh_io.h"
#include "motion/subdivision.h"

namespace echocine {

namespace {

// Single precision is good to a micrometre within this distance of the probe. Our choice.
constexpr double kMaxDistanceMetres = 10;

std::vector<double> phasesOf(const Structure& structure) {
  std::vector<double> phases;
  for (const Keyframe& keyframe : structure.keyframes) phases.push_back(keyframe.phase);
  return phases;
}

std::vector<KeyframeMesh> readKeyframes(const Structure& structure, double mesh_unit_m,
                                        Sha256& digest) {
  std::vector<KeyframeMesh> keyframes;
  for (const Keyframe& keyframe : structure.keyframes)
    keyframes.push_back(readKeyframe(keyframe, structure.place, digest));
  checkKeyframes(structure, keyframes, mesh_unit_m);
  return keyframes;
}

// A frame whose axes are left-handed mirrors space, which turns every face around.
bool mirrors(const Frame& pose) {
  return dot(cross(pose.x_axis, pose.y_axis), pose.z_axis) < 0;
}

SurfaceTopology controlTopology(const Structure& structure, SurfaceId id, const TriangleMesh& mesh,
                                const Frame& pose) {
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
    const Vec3d p = scene.probe.pose.fromWorld(scene.motion.mesh_unit_m * world);
    if (!(length(p) <= kMaxDistanceMetres))
      throw SceneError(atPlace(
          structure.place,
          fmt::format("{}: {} reaches {:.4g} m from the probe's apex, at most {:g} m is accepted: "
                      "mend motion.mesh_unit or the probe's place",
                      structure.name, keyframe.parts.front().file.string(), length(p),
                      kMaxDistanceMetres)));
    positions_m.push_back(p);
  }
  return positions_m;
}

// To single precision. What is within rounding of a coordinate plane, a picometre, is on it:
// vertices that a mesh puts exactly on the imaging plane stay there after the turn into the probe
// frame.
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

// With weights w that sum to 1, sum w p = c + sum w (p - c) stays within sum |w| times the
// keyframes' half extent of their middle c.
Box loopBox(const std::vector<std::vector<Vec3d>>& keyframes_m, double magnification) {
  Box box;
  for (const std::vector<Vec3d>& positions : keyframes_m)
    for (const Vec3d& p : positions) box.add(p);
  constexpr double kSlack = 1.01;  // the magnification is known from samples
  const double beyond = (keyframes_m.size() > 1 ? kSlack * magnification : 1) - 1;
  const Vec3d widen = std::max(beyond, 0.0) / 2 * (box.hi - box.lo);
  return {box.lo - widen, box.hi + widen};
}

// target = weight * source, or target += weight * source. Plain arrays of floats, so that the
// compiler vectorises across coordinates.
void blend(float weight, const std::vector<Vec3f>& source, bool is_first,
           std::vector<Vec3f>& target) {
  const float* const from = &source.data()->x;
  float* const to = &target.data()->x;
  const std::size_t count = 3 * source.size();
  if (is_first) {
    for (std::size_t i = 0; i < count; ++i) to[i] = weight * from[i];
  } else {
    for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
  }
}

}  // namespace

struct HeartMotion::MovingSurface {
  KeyframeWeights weights;
  std::vector<std::vector<Vec3f>>
      rows_m;  // the rows of `weights`: keyframes, then what they derive
  std::optional<Subdivision> subdivision;

  void subdivide(SurfaceTopology& topology, const MotionSettings& motion);
  void positionsAt(double phase, std::vector<Vec3f>& positions_m) const;
  void controlAt(double phase, std::vector<Vec3f>& control_m) const;
};

void HeartMotion::MovingSurface::controlAt(double phase, std::vector<Vec3f>& control_m) const {
  thread_local std::vector<KeyframeWeights::Term> terms;
  weights.termsAt(phase, terms);
  if (terms.size() == 1) {  // a keyframe, or a still structure: exactly as read
    control_m = rows_m[terms[0].row];
    return;
  }
  control_m.resize(rows_m.front().size());
  for (std::size_t i = 0; i < terms.size(); ++i)
    blend(static_cast<float>(terms[i].weight), rows_m[terms[i].row], i == 0, control_m);
}

void HeartMotion::MovingSurface::positionsAt(double phase, std::vector<Vec3f>& positions_m) const {
  if (!subdivision) return controlAt(phase, positions_m);
  thread_local std::vector<Vec3f> control_m;
  controlAt(phase, control_m);
  positions_m.resize(subdivision->vertexCount());
  subdivision->apply(control_m, positions_m);
}

// Refines the topology now and the positions of every frame; of a still structure both now.
void HeartMotion::MovingSurface::subdivide(SurfaceTopology& topology,
                                           const MotionSettings& motion) {
  subdivision.emplace(topology.triangles, topology.vertex_count, motion.subdivision,
                      motion.subdivision_place);
  topology.triangles = subdivision->triangles();
  topology.vertex_count = subdivision->vertexCount();
  if (rows_m.size() > 1) return;
  std::vector<Vec3f> refined_m(subdivision->vertexCount());
  subdivision->apply(rows_m.front(), refined_m);
  rows_m.front() = std::move(refined_m);
  subdivision.reset();
}

HeartMotion::HeartMotion(const Scene& scene) {
  Sha256 digest;
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    const Structure& structure = scene.structures[s];
    KeyframeWeights weights(phasesOf(structure), scene.motion.interpolation, structure.place);
    const auto keyframes = readKeyframes(structure, scene.motion.mesh_unit_m, digest);
    SurfaceTopology topology = controlTopology(structure, static_cast<SurfaceId>(s),
                                               keyframes.front().mesh, scene.probe.pose);
    std::vector<std::vector<Vec3d>> positions_m;
    positions_m.reserve(keyframes.size());
    for (const KeyframeMesh& keyframe : keyframes)
      positions_m.push_back(probePositions(structure, keyframe, scene));
    loop_boxes_m_.push_back(loopBox(positions_m, weights.magnification()));
    MovingSurface moving{std::move(weights), {}, std::nullopt};
    for (const std::vector<Vec3d>& positions : positions_m)
      moving.rows_m.push_back(narrowed(positions));
    for (std::size_t row = keyframes.size(); row < moving.weights.rowCount(); ++row)
      moving.rows_m.push_back(narrowed(weightedSum(moving.weights.rowWeights(row), positions_m)));
    if (scene.motion.subdivision > 0) moving.subdivide(topology, scene.motion);
    surfaces_.push_back(std::move(topology));
    moving_.push_back(std::move(moving));
  }
  input_sha256_ = digest.hex();
}

HeartMotion::~HeartMotion() = default;
HeartMotion::HeartMotion(HeartMotion&&) noexcept = default;

void HeartMotion::frameAt(double phase, SurfaceFrame& frame) const {
  frame.positions_m.resize(moving_.size());
  for (std::size_t s = 0; s < moving_.size(); ++s) {
    const bool in_place = surfaces_[s].still && !frame.positions_m[s].empty();
    if (!in_place) moving_[s].positionsAt(phase, frame.positions_m[s]);
  }
}

double enclosedVolume(const SurfaceTopology& surface, const std::vector<Vec3f>& positions_m) {
  if (surface.membrane || surface.triangles.empty()) return 0;
  CHECK_EQ(positions_m.size(), surface.vertex_count);
  const Vec3d reference = toDouble(positions_m[surface.triangles.front()[0]]);
  double six_volumes = 0;
  for (const Triangle& t : surface.triangles)
    six_volumes += dot(
        toDouble(positions_m[t[0]]) - reference,
        cross(toDouble(positions_m[t[1]]) - reference, toDouble(positions_m[t[2]]) - reference));
  return six_volumes / 6.0;
}

}  // namespace echocine
