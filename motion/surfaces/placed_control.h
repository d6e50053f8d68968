#pragma once
// A structure's keyframes in the probe frame, ready to interpolate.

#include <vector>

#include "core/box.h"
#include "motion/keyframes/control_motion.h"
#include "motion/surfaces/surface_frame.h"
#include "scene/scene.h"

namespace echocine {

// The keyframes as a motion of the control mesh in metres of the probe frame. `loop_box_m` becomes
// a box around all phases, `aside_m` wider on every side. Throws SceneError that starts with the
// structure's place for a vertex too far from the probe, and like KeyframeWeights.
ControlMotion placedControl(const std::vector<KeyframeMesh>& keyframes, const Scene& scene,
                            const Structure& structure, const SurfaceTopology& topology,
                            double aside_m, Box& loop_box_m);

}  // namespace echocine
