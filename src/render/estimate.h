#pragma once
// Cost estimate of a run, from rendering a few of its frames.

#include <nlohmann/json_fwd.hpp>

#include "render/render.h"

namespace echocine {

struct Estimate {
  Manifest measured;        // of the rendered frames: plan, stage times, work
  int frames = 0;           // of the loop
  double seconds = 0;       // for the whole loop with the same threads
  double memory_bytes = 0;  // largest resident memory while rendering
};

// Renders up to six frames of the loop into a temporary folder, which is then removed. Throws
// SceneError and JobError like renderLoop(), and JobError when keep_going() becomes false.
Estimate estimateLoop(const Scene& scene, int threads, const Monitor& monitor = {});

// The manifest's own parts, so that scripts can read both in the same way, with the pose, the white
// and the cost. `scene`: the placed scene of the estimate.
nlohmann::ordered_json estimateJson(const Scene& scene, const Estimate& estimate);

}  // namespace echocine
