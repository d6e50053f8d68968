#pragma once
// Lengths of paths that the picture can show.

#include "scene/scene.h"

namespace echocine {

// The longest path of a scan line, m: the depth of the picture. With effects.travel_time, depths
// are times at 1540 m/s, so that paths through the fastest medium are longer.
double longestPath(const Scene& scene);

}  // namespace echocine
