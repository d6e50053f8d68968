#pragma once
// A beat of the parametric heart as keyframes: control meshes for Loop subdivision, and the truth
// about them.

#include <vector>

#include "core/monitor.h"
#include "motion/heart/heart_poses.h"
#include "scene/mesh_tags.h"

namespace echocine::heart {

struct RecordedPart {
  PartKind kind;
  std::vector<Face> faces;
  MeshTags tags;
  // One entry per keyframe, one in all for what stands still. Heart coordinates, rounded to a
  // micrometre.
  std::vector<std::vector<Vec3d>> control_m;
  // Enclosed by the surface after kLevels of subdivision; empty for membranes.
  std::vector<double> volume_m3;
};

struct Recording {
  static constexpr int kLevels = 1;  // of Loop subdivision that the control meshes are meant for

  ProbePose pose;
  std::vector<double> phases;     // of the keyframes, ascending from 0
  double end_systole_phase = 0;   // when the aortic valve closes
  std::size_t end_systole = 0;    // the keyframe then, or the nearest where they are even
  std::vector<Landmarks> places;  // one per keyframe
  std::vector<RecordedPart> parts;
  // From the heart's centre to the sac, by direction of the sac's mesh: at end-diastole or
  // end-systole, whichever is more.
  std::vector<double> sac_reach_m;

  const RecordedPart& part(std::string_view name) const;  // Precondition: there is one
};

enum class KeyframeSpacing { by_motion, even };

// Phases for keyframes by motion: dense where volumes and valves move fast, with end-diastole and
// end-systole among them. Precondition: count >= 4.
std::vector<double> keyframePhases(const Cycle& cycle, int count);

// No surface folds (fold_repair.h). Runs in parallel. Throws SceneError when the heart has no shape
// at some phase or none without folds, JobError when the monitor, asked before each keyframe, wants
// to stop.
Recording record(const ParametricHeart& heart, View view, int keyframes,
                 KeyframeSpacing spacing = KeyframeSpacing::by_motion, const Monitor& monitor = {});

// The same without what lies around the heart, which surround() adds.
Recording recordBeat(const ParametricHeart& heart, View view, int keyframes,
                     KeyframeSpacing spacing = KeyframeSpacing::by_motion,
                     const Monitor& monitor = {});

// Makes what lies around the heart anew, as it is in a view whose probe stands at `pose`: the chest
// wall is the probe's, wherever it slides. The recording's own pose stays. With poseOf(view) for
// both poses the recording is what record() of that view makes. Precondition: `recording` is of
// this heart.
void surround(View view, const ProbePose& pose, const ParametricHeart& heart, Recording& recording);

}  // namespace echocine::heart
