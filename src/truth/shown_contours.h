#pragma once
// Contours where the picture shows them along sound paths, not at straight path lengths.

#include <vector>

#include "geometry/sound_paths.h"
#include "scene/scene.h"
#include "truth/contour.h"

namespace echocine {

// Contours in the picture's plane, surface by surface. A closed structure's are closed, at the
// edges of the sector too: what the paths do not reach is not known. They are joined over the
// stretches of neighbouring paths that overlap. A membrane's are open: its crossings are joined to
// those on the next path that lie within 10 times the paths' distance (84 degrees) of them in
// depth, the nearest first; what leans more is in several parts. Contour::edges is empty.
std::vector<Contour> shownContours(const Scene& scene, const SoundPaths& paths);

}  // namespace echocine
