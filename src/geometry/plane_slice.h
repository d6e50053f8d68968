#pragma once
// One frame's surfaces cut by the imaging plane: their contours, and where the scan lines meet
// them. Needs no hierarchy: the cost is a look at the heights of the facets that can reach the
// plane, and the facets on it.

#include <span>
#include <vector>

#include "geometry/crossing.h"
#include "geometry/crossing_rule.h"
#include "motion/surfaces/surface_frame.h"
#include "scene/probe.h"

namespace echocine {

// An edge of contour: a facet's cut by the imaging plane.
struct ContourEdge {
  TriangleCut cut;    // in the imaging plane, y = 0
  Vec3d area_normal;  // of the facet, outward, twice its area long
  SurfaceId surface{};
  std::uint32_t triangle = 0;
};

// With smooth normals: their values at the ends of an edge's cut, as cutNormals() has them.
using EdgeNormals = TriangleCut;

// Unit normal of an edge's facet, by facetNormal().
Vec3d unitNormal(const ContourEdge& edge);

// What every scan line meets, as RayCrossings for each line.
class PlaneSlice {
 public:
  // Surfaces in `left_out` are in no frame's slice. Preconditions: `surfaces` outlives the slice;
  // where they know their triangles near the plane, frames are of the motion that these are of.
  PlaneSlice(const std::vector<SurfaceTopology>& surfaces, const Probe& probe,
             const InsideSet& left_out = {});

  // Cuts the frame and finds the crossings of all lines. Its memory is used again from frame to
  // frame.
  void update(const SurfaceFrame& frame);

  // Cuts the frame and asks no line: edges() alone are made.
  void cut(const SurfaceFrame& frame);

  const std::vector<RayCrossings>& lines() const { return lines_; }
  const std::vector<ContourEdge>& edges() const { return edges_; }
  // One for each edge; none at all when the frame has no smooth normals.
  const std::vector<EdgeNormals>& normals() const { return normals_; }

 private:
  void cutSurface(const SurfaceTopology& surface, const std::vector<Vec3f>& positions,
                  std::vector<ContourEdge>& edges);
  void addNormals(const SurfaceFrame& frame, std::span<const ContourEdge> edges,
                  std::vector<EdgeNormals>& normals) const;
  void crossEdge(std::size_t edge);
  void crossLine(std::size_t edge, int line);
  void resolve(RayCrossings& line) const;
  int linesRightOf(Vec3d point) const;

  const std::vector<SurfaceTopology>& surfaces_;
  Probe probe_;
  std::vector<RayPlanes> rays_;
  std::vector<ContourEdge> still_edges_;  // of surfaces that never move: cut once
  bool still_cut_ = false;
  std::vector<EdgeNormals> still_normals_;
  std::vector<ContourEdge> edges_;
  std::vector<EdgeNormals> normals_;
  std::vector<RayCrossings> lines_;
  bool angular_ = true;
  double first_place_ = 0,
         lines_per_place_ = 0;  // of the lines: angles, or offsets of a linear probe
  InsideSet membranes_, left_out_;
};

}  // namespace echocine
