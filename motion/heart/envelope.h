#pragma once
// The sac round the heart.

#include <span>
#include <vector>

#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// Points, one per direction of the sphere mesh, of a smooth star-shaped surface about `centre` that
// stands at least `gap_m` outside every given point.
std::vector<Vec3d> envelopeOf(std::span<const Vec3d> points, Vec3d centre, double gap_m,
                              const SphereMesh& sphere);

}  // namespace echocine::heart
