#pragma once
// The plane slice as ground truth: chains of points per structure.

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/plane_slice.h"
#include "motion/surfaces/mesh_motion.h"

namespace echocine {

// A contour in the imaging plane (y = 0), metres in the probe frame. Closed surfaces give closed
// contours (the last point joins the first), and so may membranes; edges are joined over the
// mesh's edges, not by nearness.
struct Contour {
  SurfaceId surface{};
  bool closed = false;
  std::vector<Vec3d> points_m;
  // The given edge that starts at each point; none at the last point of an open contour.
  std::vector<std::uint32_t> edges;
};

// All contours of the frame that `edges` were cut from, surface by surface.
std::vector<Contour> chainContours(std::span<const ContourEdge> edges,
                                   const std::vector<SurfaceTopology>& surfaces,
                                   const SurfaceFrame& frame);

// All contours in the probe's plane at a phase, which may be any number of beats. Allocates all it
// needs: for a few frames, where TruthMaker is for a loop. Thread-safe.
std::vector<Contour> contoursAt(const MeshMotion& motion, const Probe& probe, double phase);

}  // namespace echocine
