#pragma once
// Where a leaflet is free: by how far its vertices move over the beat.

#include <span>
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

// Positions of some surfaces at 16 instants of the beat.
std::vector<SurfaceFrame> instantsOfBeat(const MeshMotion& motion, std::span<const SurfaceId> some);

// How far each vertex of a surface moves from its place at the first instant, between the least and
// the most of its surface: 0 to 1. All 0 for a surface that does not move.
std::vector<float> shareOfMotion(const std::vector<SurfaceFrame>& instants, std::size_t surface);

}  // namespace echocine
