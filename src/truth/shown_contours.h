#pragma once
// Contours at their positions in the picture, along sound paths instead of straight path lengths.

#include <vector>

#include "geometry/sound_paths.h"
#include "scene/scene.h"
#include "truth/contour.h"

namespace echocine {

// Contours in the picture's plane, surface by surface. Contours of closed structures are closed,
// also along the edges of the sector, because paths do not reach further. Their intervals on
// neighbouring paths are joined where they overlap. Contours of membranes are open. A crossing is
// joined to the nearest one on the next path if their depths differ by less than 10 times the
// distance of the paths (84 degrees); steeper sheets are in several parts. Contour::edges is empty.
std::vector<Contour> shownContours(const Scene& scene, const SoundPaths& paths);

}  // namespace echocine
