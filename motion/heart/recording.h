#pragma once
// A beat of the parametric heart as keyframes: control meshes for Loop subdivision, and their
// ground truth.

#include <vector>

#include "core/monitor.h"
#include "motion/heart/heart_poses.h"
#include "scene/mesh_tags.h"

namespace echocine::heart {

struct RecordedPart {
  PartKind kind;
  std::vector<Face> faces;
  MeshTags tags;
  // One entry per keyframe; a single one for a static part. Heart coordinates, rounded to a
  // micrometre.
  std::vector<std::vector<Vec3d>> control_m;
  // Volume within the surface after kLevels of subdivision; empty for membranes, and unless
  // record() made the part.
  std::vector<double> volume_m3;
};

struct Recording {
  static constexpr int kLevels =
      1;  // levels of Loop subdivision for which the control meshes are fitted

  int levels = kLevels;  // of the meshes; 0: of coarseSurfaces()
  ProbePose pose;
  std::vector<double> phases;     // of the keyframes, ascending from 0
  double body_scale = 1;          // 1: an adult's
  double end_systole_phase = 0;   // closure of the aortic valve
  std::size_t end_systole = 0;    // the keyframe at that phase, or the nearest of even ones
  std::vector<Landmarks> places;  // one per keyframe
  std::vector<RecordedPart> parts;
  // Distance from the heart's centre to the sac, by direction of the sac's mesh: the larger of
  // end-diastole and end-systole.
  std::vector<double> sac_reach_m;

  const RecordedPart& part(std::string_view name) const;  // Precondition: it exists
};

enum class KeyframeSpacing { by_motion, even };

// Phases of keyframes by motion: dense where volumes and valves move fast, including end-diastole
// and end-systole. Precondition: count >= 4.
std::vector<double> keyframePhases(const Cycle& cycle, int count);

// Surfaces do not fold (fold_repair.h). Runs in parallel. Throws SceneError if the heart has no
// valid shape at some phase, JobError when the monitor, polled before each keyframe, requests a
// stop.
Recording record(const ParametricHeart& heart, View view, int keyframes,
                 KeyframeSpacing spacing = KeyframeSpacing::by_motion, const Monitor& monitor = {});

// The same without volumes, and without the surroundings of the heart, which surround() adds.
Recording recordBeat(const ParametricHeart& heart, View view, int keyframes,
                     KeyframeSpacing spacing = KeyframeSpacing::by_motion,
                     const Monitor& monitor = {});

// Recomputes the surroundings of the heart for a view whose probe is at `pose`: the chest wall is
// at the probe. The recording's own pose is unchanged. With poseOf(view) for both poses the
// recording equals that of record() for the view, except volumes. Precondition: `recording` is of
// this heart.
void surround(View view, const ProbePose& pose, const ParametricHeart& heart, Recording& recording);

}  // namespace echocine::heart
