#pragma once
// The plane slice as ground truth: chains of points per structure.

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/plane_slice.h"
#include "motion/surfaces/mesh_motion.h"
#include "truth/truth_values.h"

namespace echocine {

// All contours of the frame that `edges` were cut from, surface by surface.
std::vector<Contour> chainContours(std::span<const ContourEdge> edges,
                                   const std::vector<SurfaceTopology>& surfaces,
                                   const SurfaceFrame& frame);

// All contours in the probe's plane at a phase, which may be beyond one beat. Allocates its memory
// in each call, so it suits a few frames; TruthMaker suits a loop. Thread-safe.
std::vector<Contour> contoursAt(const MeshMotion& motion, const Probe& probe, double phase);

}  // namespace echocine
