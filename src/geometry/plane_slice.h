#pragma once
// Intersection of one frame's surfaces with the imaging plane: their contours, and the crossings of
// scan lines. It needs no hierarchy: it checks the heights of facets that can reach the plane, and
// processes the facets on it.

#include <span>
#include <vector>

#include "geometry/crossing.h"
#include "geometry/crossing_rule.h"
#include "motion/surfaces/surface_frame.h"
#include "scene/probe.h"

namespace echocine {

// A contour edge: the intersection of a facet with the imaging plane.
struct ContourEdge {
  TriangleCut cut;    // in the imaging plane, y = 0
  Vec3d area_normal;  // of the facet, outward; its length is twice the area
  SurfaceId surface{};
  std::uint32_t triangle = 0;
};

// With smooth normals: their values at the ends of an edge's cut, by cutNormals().
using EdgeNormals = TriangleCut;

// Unit normal of an edge's facet, by facetNormal().
Vec3d unitNormal(const ContourEdge& edge);

// The crossings of every scan line, as RayCrossings.
class PlaneSlice {
 public:
  // Surfaces in `left_out` are omitted. Preconditions: `surfaces` outlives the slice; if they have
  // near_plane, frames are of the motion for which it was computed.
  PlaneSlice(const std::vector<SurfaceTopology>& surfaces, const Probe& probe,
             const InsideSet& left_out = {});

  // Cuts the frame and computes the crossings of all lines. Memory is reused from frame to frame.
  void update(const SurfaceFrame& frame);

  // Cuts the frame without lines: only edges().
  void cut(const SurfaceFrame& frame);

  const std::vector<RayCrossings>& lines() const { return lines_; }
  const std::vector<ContourEdge>& edges() const { return edges_; }
  // One for each edge; empty if the frame has no smooth normals.
  const std::vector<EdgeNormals>& normals() const { return normals_; }

 private:
  void cutSurface(const SurfaceTopology& surface, const SurfaceFrame& frame,
                  std::vector<ContourEdge>& edges);
  void addNormals(const SurfaceFrame& frame, std::span<const ContourEdge> edges,
                  std::vector<EdgeNormals>& normals) const;
  void crossEdge(std::size_t edge);
  void crossEdgeAround(std::size_t edge);
  void crossLine(std::size_t edge, int line);
  void resolve(RayCrossings& line) const;
  int linesRightOf(Vec3d point) const;
  int linesRightOf(Vec3d point, int guess) const;

  const std::vector<SurfaceTopology>& surfaces_;
  Probe probe_;
  std::vector<RayPlanes> rays_;
  std::vector<ContourEdge> still_edges_;  // of static surfaces: cut once
  bool still_cut_ = false;
  std::vector<EdgeNormals> still_normals_;
  std::vector<ContourEdge> edges_;
  std::vector<EdgeNormals> normals_;
  std::vector<RayCrossings> lines_;
  bool angular_ = true;
  double first_place_ = 0,
         lines_per_place_ = 0;  // coordinate of the lines: angles, or offsets of a linear probe
  InsideSet membranes_, left_out_;
};

}  // namespace echocine
