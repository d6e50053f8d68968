#pragma once
// Displacement of the material at every sample since the reference frame, and its velocity.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/sound_paths.h"
#include "motion/interior/motion_field.h"
#include "scene/scene.h"
#include "truth/truth_values.h"

namespace echocine {

// The field at the first frame, at this frame, and shortly before and after it.
struct FieldTimes {
  const FieldFrame* first;  // null where its phase is the reference phase: nothing has moved
  const FieldFrame &now, &before, &after;
  double seconds = 0;  // from before to after
};

// For each group: whether it is tissue, whose motion motionPlanes() reports.
std::vector<bool> tissueGroups(const Scene& scene, const MotionField& field);

// ids: every sample's structure, from 1. Blood and the background have no motion, because blood is
// renewed and the background is unknown. Samples lie on their lines at straight path lengths, or on
// `paths` if given. velocity: makes it too, with its part along the line. Displacement is the true
// one, of the material that the sample shows.
void motionPlanes(const Scene& scene, const MotionField& field, const FieldTimes& times,
                  std::span<const std::uint32_t> ids, bool velocity, const SoundPaths* paths,
                  MotionPlanes& planes);

}  // namespace echocine
