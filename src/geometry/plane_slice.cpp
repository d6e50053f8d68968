#include "geometry/plane_slice.h"

#include <algorithm>
#include <cmath>

#include "core/rough_angle.h"
#include "geometry/line_states.h"
#include "geometry/smooth_normal.h"
#include "scene/scan_geometry.h"

namespace echocine {

Vec3d unitNormal(const ContourEdge& edge) {
  return facetNormal(edge.area_normal, edge.cut, {0, 1, 0});
}

PlaneSlice::PlaneSlice(const std::vector<SurfaceTopology>& surfaces, const Probe& probe,
                       const InsideSet& left_out)
    : surfaces_(surfaces), probe_(probe), left_out_(left_out) {
  for (int i = 0; i < probe.lines; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    rays_.emplace_back(Ray{line.origin, line.direction});
  }
  lines_.resize(rays_.size());
  const ScanGeometry geometry(probe);
  angular_ = geometry.angular();
  first_place_ = geometry.firstPlace();
  lines_per_place_ = probe.lines > 1 ? 1 / geometry.cellWidth() : 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) membranes_[s] = surfaces[s].membrane;
}

// A facet costs three sides unless it is cut.
void PlaneSlice::cutSurface(const SurfaceTopology& surface, const SurfaceFrame& frame,
                            std::vector<ContourEdge>& edges) {
  const std::vector<Vec3f>& positions = frame.positions_m[index(surface.id)];
  const Vec3f* position = positions.data();
  const auto cut = [&](const Triangle& corner, std::uint32_t number, const auto& above) {
    const int sides = above(corner[0]) + above(corner[1]) + above(corner[2]);
    if (sides == 0 || sides == 3) return;
    const Vec3d p0 = toDouble(position[corner[0]]), p1 = toDouble(position[corner[1]]),
                p2 = toDouble(position[corner[2]]);
    edges.push_back(
        {*cutTriangle(p0, p1, p2, p0.y, p1.y, p2.y), areaNormal(p0, p1, p2), surface.id, number});
  };
  const auto sideOf = [&](std::uint32_t v) { return position[v].y >= 0 ? 1 : 0; };
  if (surface.near_plane) {
    for (const NumberedTriangle& t : *surface.near_plane) cut(t.corners, t.number, sideOf);
    return;
  }
  if (!frame.near_plane.empty()) {
    for (const TriangleRange range : frame.near_plane[index(surface.id)])
      for (std::uint32_t t = range.first; t < range.end; ++t) cut(surface.triangles[t], t, sideOf);
    return;
  }
  // Each vertex serves six facets.
  thread_local std::vector<std::uint8_t> above;
  above.resize(positions.size());
  for (std::size_t v = 0; v < above.size(); ++v) above[v] = position[v].y >= 0 ? 1 : 0;
  const auto count = static_cast<std::uint32_t>(surface.triangles.size());
  for (std::uint32_t t = 0; t < count; ++t)
    cut(surface.triangles[t], t, [from = above.data()](std::uint32_t v) { return int{from[v]}; });
}

void PlaneSlice::addNormals(const SurfaceFrame& frame, std::span<const ContourEdge> edges,
                            std::vector<EdgeNormals>& normals) const {
  for (const ContourEdge& edge : edges) {
    const SurfaceTopology& surface = surfaces_[index(edge.surface)];
    const std::vector<Vec3f>& position = frame.positions_m[index(surface.id)];
    const std::vector<Vec3f>& normal = frame.normals[index(surface.id)];
    const Triangle& corner = surface.triangles[edge.triangle];
    const Triangle& n = surface.normalCorners()[edge.triangle];
    normals.push_back(cutNormals({normal[n[0]], normal[n[1]], normal[n[2]]}, position[corner[0]].y,
                                 position[corner[1]].y, position[corner[2]].y));
  }
}

// How many lines, counted from the first, have the point at u >= 0: the lines turn (or move) from
// left to right, so that is all lines up to some index. Guessed from the point's direction and made
// exact by the rule itself. Precondition: z >= 0, where u >= 0 changes once over a sector of up to
// 180 degrees.
int PlaneSlice::linesRightOf(Vec3d point) const {
  const double place = angular_ ? roughAngle(point.x, point.z) : point.x;
  const double guess = std::floor((place - first_place_) * lines_per_place_) + 1;
  return linesRightOf(point,
                      static_cast<int>(std::clamp(guess, 0.0, static_cast<double>(probe_.lines))));
}

int PlaneSlice::linesRightOf(Vec3d point, int guess) const {
  const int lines = probe_.lines;
  int n = guess;
  const auto right = [&](int line) {
    const RayPlanes& ray = rays_[static_cast<std::size_t>(line)];
    return dot(ray.u_axis, point - ray.origin) >= 0;
  };
  while (n < lines && right(n)) ++n;
  while (n > 0 && !right(n - 1)) --n;
  return n;
}

void PlaneSlice::crossLine(std::size_t number, int line) {
  const auto i = static_cast<std::size_t>(line);
  const ContourEdge& edge = edges_[number];
  const std::optional<CutCrossing> c = crossCut(rays_[i], edge.cut);
  if (!c) return;
  lines_[i].crossings.push_back(
      {c->distance_m, unitNormal(edge), edge.surface, edge.triangle, c->entering});
  if (!normals_.empty())
    makeSmooth(rays_[i], edge.cut, normals_[number], lines_[i].crossings.back());
}

// A edge meets the lines between its ends. Where it reaches behind the plane z = 0 of the
// transducer every line is asked, since there its ends may lie more than half a turn apart.
void PlaneSlice::crossEdge(std::size_t number) {
  if (probe_.isFullTurn()) return crossEdgeAround(number);
  const ContourEdge& edge = edges_[number];
  const bool behind1 = edge.cut.from.z < 0, behind2 = edge.cut.to.z < 0;
  if (behind1 && behind2) return;  // lines never point backwards
  int begin = 0, end = probe_.lines;
  if (!behind1 && !behind2) {
    // Each line between the ends is crossed, so the walk from one end to the other is short.
    const int n1 = linesRightOf(edge.cut.from), n2 = linesRightOf(edge.cut.to, n1);
    begin = std::min(n1, n2);
    end = std::max(n1, n2);
  }
  for (int i = begin; i < end; ++i) crossLine(number, i);
}

// An edge spans less than half a turn: the lines of the short way from end to end, and one more on
// both sides because directions are approximate. Each line decides for itself.
void PlaneSlice::crossEdgeAround(std::size_t number) {
  const ContourEdge& edge = edges_[number];
  const int lines = probe_.lines;
  const auto place = [&](Vec3d p) {
    return (roughAngle(p.x, p.z) - first_place_) * lines_per_place_;
  };
  const double from = place(edge.cut.from);
  const double way = std::remainder(place(edge.cut.to) - from, lines);
  const int first = static_cast<int>(std::floor(std::min(from, from + way))) - 1;
  const int last = static_cast<int>(std::ceil(std::max(from, from + way))) + 1;
  // An edge that nearly meets the apex may pass it on either side.
  const int count = last - first + 1 >= lines / 2 ? lines : last - first + 1;
  for (int i = 0; i < count; ++i) crossLine(number, ((first + i) % lines + lines) % lines);
}

// Contours of closed surfaces close exactly, so the crossings of a line determine the medium of
// its start.
void PlaneSlice::resolve(RayCrossings& line) const {
  thread_local std::vector<int> depth;
  depth.resize(surfaces_.size());
  balances(line.crossings, depth);
  line.inside.reset();
  InsideSet clamped;
  for (std::size_t s = 0; s < depth.size(); ++s) {
    if (membranes_[s] || depth[s] == 0) continue;
    clamped[s] = depth[s] > 0;  // cannot be: more entries than exits
    depth[s] = std::max(-depth[s], 0);
    line.inside[s] = depth[s] > 0;
  }
  std::sort(line.crossings.begin(), line.crossings.end(), nearer);
  keepChanges(line.crossings, depth, membranes_, clamped);
}

void PlaneSlice::cut(const SurfaceFrame& frame) {
  for (RayCrossings& line : lines_) line.crossings.clear();
  normals_.clear();
  const auto cutAll = [&](bool still, std::vector<ContourEdge>& edges) {
    for (const SurfaceTopology& surface : surfaces_)
      if (surface.still == still && !left_out_[index(surface.id)])
        cutSurface(surface, frame, edges);
  };
  if (!still_cut_) cutAll(true, still_edges_);
  still_cut_ = true;
  edges_ = still_edges_;
  cutAll(false, edges_);
}

void PlaneSlice::update(const SurfaceFrame& frame) {
  cut(frame);
  if (!frame.normals.empty()) {
    if (still_normals_.empty()) addNormals(frame, still_edges_, still_normals_);
    normals_ = still_normals_;
    addNormals(frame, std::span(edges_).subspan(still_edges_.size()), normals_);
  }
  for (std::size_t edge = 0; edge < edges_.size(); ++edge) crossEdge(edge);
  for (RayCrossings& line : lines_) resolve(line);
}

}  // namespace echocine
