#pragma once
// The M-mode as a grey picture.

#include "mmode/mmode.h"
#include "scene/scene.h"
#include "signal/picture.h"

namespace echocine {

// Time to the right, one pixel per column; depth down, `rows` pixels, linear between samples, with
// the scene's grey map. Below: the ECG (scene.output.ecg). Ticks (scene.output.depth_ticks): on the
// right each centimetre, longer each 5 cm; under the picture each 0.1 s, longer each 0.5 s.
// Precondition: rows >= 16.
GreyImage mmodePicture(const MMode& mode, const Scene& scene, double rate_hz, int rows);

}  // namespace echocine
