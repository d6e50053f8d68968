#pragma once
// What a run of a scene will take, from rendering a few of its frames.

#include "render/render.h"

namespace echocine {

struct Estimate {
  Manifest measured;        // of the frames that were rendered: plan, stage times, work
  int frames = 0;           // of the loop
  double seconds = 0;       // for the whole loop with the same threads
  double memory_bytes = 0;  // most resident memory while rendering
};

// Renders up to six frames of the loop to a temporary folder, which is removed.
// Throws SceneError and JobError as renderLoop() does, and a JobError when keep_going() says no.
Estimate estimateLoop(const Scene& scene, int threads, const Monitor& monitor = {});

}  // namespace echocine
