#include "geometry/frame_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "geometry/crossing_rule.h"
#include "geometry/embree_mesh.h"
#include "geometry/line_states.h"
#include "geometry/positions_box.h"
#include "geometry/smooth_normal.h"

namespace echocine {

// All surfaces are concatenated into one mesh: Embree then refits one hierarchy and builds
// none, while over several meshes it builds one anew for each frame, which takes longer than to
// refit 50 000 triangles and stops the program where triangles have shrunk to a point. In return
// surfaces that slide against each other after the first frame loosen the boxes: measured on nested
// balls, rays take up to a quarter longer after 1 cm and up to twice as long after 3 cm. Numbers of
// that mesh's triangles are called places.
struct FrameGeometry::State {
  const std::vector<SurfaceTopology>& surfaces;
  std::vector<std::uint32_t> first_vertex, first_place;  // by surface; absent ones have none
  std::vector<std::uint8_t> surface_at;                  // by place
  std::vector<std::vector<Vec3f>> normals;               // smooth ones, if the frame has any
  std::vector<Box> boxes;
  InsideSet membranes, absent;
  EmbreeMesh mesh;
  Vec3f* vertices = nullptr;      // the mesh's own
  Triangle* triangles = nullptr;  // by place
  bool held = false;              // a frame was taken over: still surfaces are in place

  State(const std::vector<SurfaceTopology>& topology, const InsideSet& left_out);
  std::uint32_t countPlaces();
  void fillTriangles();
  Crossing crossingAt(std::uint32_t place) const;
  std::optional<Crossing> cross(const RayPlanes& ray, std::uint32_t place) const;
  void crossAll(const RayPlanes& ray, std::uint32_t surface, std::vector<Crossing>& out) const;
  void crossCandidates(const RayQuery& query, const RayPlanes& planes,
                       std::vector<std::uint32_t>& found, std::vector<Crossing>& out) const;
  void crossFour(const RayPlanes& ray, std::span<const std::uint32_t> found,
                 std::vector<Crossing>& out, std::vector<std::uint32_t>& refused) const;
  bool hasNeighbour(std::uint32_t place, const std::vector<Crossing>& crossings) const;
  void recount(const RayQuery& query, std::uint32_t surface,
               std::vector<Crossing>& crossings) const;
  void proveStates(const RayQuery& query, RayCrossings& out) const;
  void repairStates(const RayQuery& query, RayCrossings& out) const;
  void smoothNormals(const RayPlanes& planes, std::vector<Crossing>& crossings) const;
};

FrameGeometry::State::State(const std::vector<SurfaceTopology>& topology, const InsideSet& left_out)
    : surfaces(topology), boxes(topology.size()), absent(left_out) {
  CHECK_LE(topology.size(), kMaxSurfaces);
  const std::uint32_t vertex_count = countPlaces();
  mesh.reserve(vertex_count, surface_at.size());
  vertices = mesh.vertices();
  triangles = mesh.triangles();
  fillTriangles();
}

// Where each surface starts in the mesh; returns how many vertices it has.
std::uint32_t FrameGeometry::State::countPlaces() {
  static_assert(kMaxSurfaces <= 256, "a surface's number is kept in a byte");
  std::uint32_t vertex_count = 0;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    membranes[s] = surfaces[s].membrane;
    first_vertex.push_back(vertex_count);
    first_place.push_back(static_cast<std::uint32_t>(surface_at.size()));
    if (absent[s]) continue;
    vertex_count += surfaces[s].vertex_count;
    surface_at.resize(surface_at.size() + surfaces[s].triangles.size(),
                      static_cast<std::uint8_t>(s));
  }
  return vertex_count;
}

void FrameGeometry::State::fillTriangles() {
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (absent[s]) continue;
    const std::uint32_t v = first_vertex[s];
    std::transform(surfaces[s].triangles.begin(), surfaces[s].triangles.end(),
                   triangles + first_place[s], [v](const Triangle& t) {
                     return Triangle{t[0] + v, t[1] + v, t[2] + v};
                   });
  }
}

// Crossing at a place, with the properties of its surface and triangle only.
Crossing FrameGeometry::State::crossingAt(std::uint32_t place) const {
  Crossing crossing;
  crossing.surface = SurfaceId{surface_at[place]};
  crossing.triangle = place - first_place[surface_at[place]];
  return crossing;
}

std::optional<Crossing> FrameGeometry::State::cross(const RayPlanes& ray,
                                                    std::uint32_t place) const {
  const Triangle& t = triangles[place];
  const Crossing at = crossingAt(place);
  return crossTriangle(ray, vertices[t[0]], vertices[t[1]], vertices[t[2]], at.surface,
                       at.triangle);
}

// Every triangle of a surface against the rule, without the hierarchy. Triangles entirely on one
// side of the ray's plane are recognised by their vertices.
void FrameGeometry::State::crossAll(const RayPlanes& ray, std::uint32_t surface,
                                    std::vector<Crossing>& out) const {
  const SurfaceTopology& topology = surfaces[surface];
  const Vec3f* const own = vertices + first_vertex[surface];
  thread_local std::vector<std::uint8_t> above;
  above.resize(topology.vertex_count);
  for (std::size_t v = 0; v < above.size(); ++v)
    above[v] = dot(ray.v_axis, toDouble(own[v]) - ray.origin) >= 0 ? 1 : 0;
  for (std::uint32_t i = 0; i < topology.triangles.size(); ++i) {
    const Triangle& t = topology.triangles[i];
    const int count = above[t[0]] + above[t[1]] + above[t[2]];
    if (count == 0 || count == 3) continue;
    if (const std::optional<Crossing> c = cross(ray, first_place[surface] + i)) out.push_back(*c);
  }
}

// Four candidates at once; fewer leave the last one in the rest of the lanes.
void FrameGeometry::State::crossFour(const RayPlanes& ray, std::span<const std::uint32_t> found,
                                     std::vector<Crossing>& out,
                                     std::vector<std::uint32_t>& refused) const {
  static_assert(kDoubleLanes == 4);
  const Triangle* of_lane[kDoubleLanes];
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane)
    of_lane[lane] = &triangles[found[std::min(lane, found.size() - 1)]];
  std::array<Vec3<Floats4>, 3> corners;
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3f &p = vertices[(*of_lane[0])[c]], &q = vertices[(*of_lane[1])[c]],
                &r = vertices[(*of_lane[2])[c]], &s = vertices[(*of_lane[3])[c]];
    corners[c] = {Floats4{p.x, q.x, r.x, s.x}, Floats4{p.y, q.y, r.y, s.y},
                  Floats4{p.z, q.z, r.z, s.z}};
  }
  const LaneCrossings met = crossTriangles(ray, corners);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (met.crossed[i] == 0) {
      refused.push_back(found[i]);
      continue;
    }
    Crossing& c = out.emplace_back(crossingAt(found[i]));
    c.distance_m = met.distance_m[i];
    c.normal = {met.normal.x[i], met.normal.y[i], met.normal.z[i]};
    c.entering = met.entering[i] != 0;
    if (!isFinite(c.normal)) c = *cross(ray, found[i]);
  }
}

// Embree's candidates, each decided by the rule. Duplicates stay: proveStates() drops them.
void FrameGeometry::State::crossCandidates(const RayQuery& query, const RayPlanes& planes,
                                           std::vector<std::uint32_t>& found,
                                           std::vector<Crossing>& out) const {
  out.clear();
  thread_local std::vector<std::uint32_t> refused;
  refused.clear();
  for (const auto& [surface, triangle] : query.left_behind)
    std::erase(found, first_place[index(surface)] + triangle);
  for (std::size_t i = 0; i < found.size(); i += kDoubleLanes)
    crossFour(planes, std::span(found).subspan(i, std::min(kDoubleLanes, found.size() - i)), out,
              refused);
  for (const std::uint32_t place : refused)
    if (!hasNeighbour(place, out)) recount(query, surface_at[place], out);
}

// On a shared vertex or edge Embree may report only a triangle that the rule refuses, and not the
// one beside it that the rule takes. When that happens where a ray enters and where it leaves, the
// balance of proveStates still holds, and a membrane has no balance: so a refused candidate must
// have an accepted one at a common vertex.
bool FrameGeometry::State::hasNeighbour(std::uint32_t place,
                                        const std::vector<Crossing>& crossings) const {
  const Triangle& t = triangles[place];
  return std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& c) {
    const Triangle& other = triangles[first_place[index(c.surface)] + c.triangle];
    return std::find_first_of(t.begin(), t.end(), other.begin(), other.end()) != t.end();
  });
}

// A closed surface's entries and exits balance with the state at the start. Where they do not,
// Embree has lost a crossing (a ray within rounding of an edge), the start lies on the surface, or
// a refracted ray has met the neighbour of the triangle it starts from: then every triangle is
// asked.
void FrameGeometry::State::recount(const RayQuery& query, std::uint32_t surface,
                                   std::vector<Crossing>& crossings) const {
  std::erase_if(crossings, [&](const Crossing& c) { return index(c.surface) == surface; });
  crossAll(RayPlanes(query.ray), surface, crossings);
  for (const std::pair<SurfaceId, std::uint32_t>& left : query.left_behind)
    std::erase_if(crossings, [&](const Crossing& c) {
      return c.surface == left.first && c.triangle == left.second;
    });
}

// Where crossings do not alternate: states and crossings that hold together.
void FrameGeometry::State::repairStates(const RayQuery& query, RayCrossings& out) const {
  thread_local std::vector<int> balance, depth;
  balance.resize(surfaces.size());
  depth.resize(surfaces.size());
  InsideSet clamped;
  balances(out.crossings, balance);
  for (std::uint32_t s = 0; s < surfaces.size(); ++s) {
    depth[s] = query.inside[s] ? 1 : 0;
    if (absent[s] || membranes[s] || balance[s] == -depth[s]) continue;
    recount(query, s, out.crossings);
    int recounted = 0;
    for (const Crossing& c : out.crossings)
      if (index(c.surface) == s) recounted += c.entering ? 1 : -1;
    if (query.left_behind.empty()) depth[s] = std::max(-recounted, 0);
    clamped[s] = recounted != -depth[s];
    out.inside[s] = depth[s] > 0;
  }
  std::sort(out.crossings.begin(), out.crossings.end(), nearer);
  keepChanges(out.crossings, depth, membranes, clamped);
}

void FrameGeometry::State::proveStates(const RayQuery& query, RayCrossings& out) const {
  putInOrder(out.crossings);
  out.inside = query.inside;
  if (!statesAlternate(out.crossings, query.inside, membranes)) repairStates(query, out);
}

// Replaces the crossings' normals by smooth ones; their other members stay.
void FrameGeometry::State::smoothNormals(const RayPlanes& planes,
                                         std::vector<Crossing>& crossings) const {
  for (Crossing& c : crossings) {
    const auto s = index(c.surface);
    const Triangle& t = triangles[first_place[s] + c.triangle];
    const Triangle& n = surfaces[s].normalCorners()[c.triangle];
    const Vec3d p[3] = {toDouble(vertices[t[0]]), toDouble(vertices[t[1]]),
                        toDouble(vertices[t[2]])};
    const auto height = [&](Vec3d q) { return dot(planes.v_axis, q - planes.origin); };
    const double v[3] = {height(p[0]), height(p[1]), height(p[2])};
    const std::vector<Vec3f>& normal = normals[s];
    makeSmooth(planes, *cutTriangle(p[0], p[1], p[2], v[0], v[1], v[2]),
               cutNormals({normal[n[0]], normal[n[1]], normal[n[2]]}, v[0], v[1], v[2]), c);
  }
}

FrameGeometry::FrameGeometry(const std::vector<SurfaceTopology>& surfaces,
                             const InsideSet& left_out)
    : state_(std::make_unique<State>(surfaces, left_out)) {}
FrameGeometry::~FrameGeometry() = default;
FrameGeometry::FrameGeometry(FrameGeometry&&) noexcept = default;

void FrameGeometry::update(const SurfaceFrame& frame) {
  State& s = *state_;
  s.normals.resize(frame.normals.size());
  for (std::size_t i = 0; i < s.surfaces.size(); ++i) {
    if (s.absent[i] || (s.surfaces[i].still && s.held)) continue;
    std::copy(frame.positions_m[i].begin(), frame.positions_m[i].end(),
              s.vertices + s.first_vertex[i]);
    s.boxes[i] = boxOf(frame.positions_m[i]);
    if (!frame.normals.empty()) s.normals[i] = frame.normals[i];
  }
  s.held = true;
  s.mesh.refit();
}

InsideSet FrameGeometry::insideAt(Vec3d point) const {
  InsideSet inside;
  std::vector<Crossing> met;
  const RayPlanes depthwards(Ray{point, {0, 0, 1}});
  for (std::uint32_t i = 0; i < state_->surfaces.size(); ++i) {
    if (state_->absent[i] || state_->surfaces[i].membrane || !state_->boxes[i].contains(point))
      continue;
    met.clear();
    state_->crossAll(depthwards, i, met);
    int balance = 0;
    for (const Crossing& c : met) balance += c.entering ? 1 : -1;
    inside[i] = balance < 0;
  }
  return inside;
}

void FrameGeometry::crossings(std::span<const RayQuery> rays, std::span<RayCrossings> out) const {
  thread_local EmbreeMesh::Candidates found;
  state_->mesh.candidates(rays, found);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayPlanes planes(rays[i].ray);
    state_->crossCandidates(rays[i], planes, found[i], out[i].crossings);
    state_->proveStates(rays[i], out[i]);
    if (!state_->normals.empty()) state_->smoothNormals(planes, out[i].crossings);
  }
}

}  // namespace echocine
