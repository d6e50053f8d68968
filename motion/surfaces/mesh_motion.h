#pragma once
// The moving surfaces of a scene: keyframe meshes in, surfaces at any phase out.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/box.h"
#include "motion/keyframes/control_motion.h"
#include "motion/surfaces/keyframe_set.h"
#include "motion/surfaces/surface_frame.h"
#include "scene/scene.h"

namespace echocine {

class MeshMotion {
 public:
  // Prepares interpolation and subdivision of keyframes for the scene's motion, probe and accuracy.
  // Throws SceneError naming the scene's place, the file and the face or vertex.
  MeshMotion(const KeyframeSet& keyframes, const Scene& scene);
  explicit MeshMotion(const Scene& scene);  // uses readKeyframes(scene)
  ~MeshMotion();
  MeshMotion(MeshMotion&&) noexcept;

  const std::vector<SurfaceTopology>& surfaces() const { return surfaces_; }

  // A box around each surface at all phases: the keyframes' box, widened by the possible overshoot
  // of the interpolation (subdivision stays within its control points). Probe frame, m.
  const std::vector<Box>& loopBoxes() const { return loop_boxes_m_; }

  // The surfaces at a phase in [0, 1); keyframe phases reproduce their keyframes. Thread-safe;
  // `frame` is reused without allocation once it has held a frame of this motion. normals: also
  // smooth normals, if hasNormals().
  void frameAt(double phase, SurfaceFrame& frame, bool normals = true) const;

  // The positions of some surfaces only, with the same bits. Others in `frame` stay as they are.
  void positionsAt(double phase, std::span<const SurfaceId> some, SurfaceFrame& frame) const;

  // Can the surfaces give smooth normals? True if the scene requests them or its rays may bend.
  bool hasNormals() const { return smooth_normals_; }

  // Volume within a surface in a frame of this motion, equal to enclosedVolume() within rounding in
  // double; precomputed for a static surface. Thread-safe. m^3.
  double volumeIn(const SurfaceFrame& frame, const SurfaceTopology& surface) const;

  // The interpolated control mesh, before subdivision.
  const ControlMotion& control(SurfaceId id) const;

  // Repairs requested by the scene: a line for each structure.
  const std::vector<std::string>& repairNotes() const { return repair_notes_; }

  // SHA-256 over all input, in the scene's order.
  const std::string& inputSha256() const { return input_sha256_; }

 private:
  struct MovingSurface;
  struct Prepared;
  std::vector<SurfaceTopology> surfaces_;
  std::vector<MovingSurface> moving_;
  std::vector<Box> loop_boxes_m_;
  std::vector<std::string> repair_notes_;
  bool smooth_normals_ = false;
  std::string input_sha256_;
};

// Volume within a closed surface, positive if its faces look outward; 0 for a membrane. m^3.
double enclosedVolume(const SurfaceTopology& surface, const std::vector<Vec3f>& positions_m);

}  // namespace echocine
