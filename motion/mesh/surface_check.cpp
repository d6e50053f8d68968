#include "motion/mesh/surface_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "motion/mesh/coincidence.h"
#include "motion/mesh/corner_fans.h"
#include "motion/mesh/mesh_check.h"
#include "motion/mesh/nesting.h"

namespace echocine {

namespace {

// Vertices are named by position, because the indices of a joined mesh belong to different files.
std::string pointName(const TriangleMesh& mesh, std::uint32_t vertex) {
  const Vec3d p = mesh.positions[vertex];
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

std::string edgeName(const TriangleMesh& mesh, std::uint64_t key) {
  return fmt::format("{} - {}", pointName(mesh, static_cast<std::uint32_t>(key >> 32)),
                     pointName(mesh, static_cast<std::uint32_t>(key)));
}

[[noreturn]] void fail(const Structure& structure, const std::string& what, RepairOffer offer,
                       std::string after = {}) {
  throw MeshFault(atPlace(structure.place, fmt::format("{}: {}", structure.name, what)),
                  std::move(offer), std::move(after));
}

bool sameCorners(Triangle a, Triangle b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

[[noreturn]] void failCrowded(const Structure& structure, const KeyframeMesh& keyframe,
                              std::span<const Side> edge) {
  const auto corners = [&](const Side& side) { return keyframe.mesh.triangles[side.triangle()]; };
  std::string advice = "separate the surfaces that meet there";
  RepairOffer offer = offerOf(structure.repair.split, "split");
  for (const Side& one : edge)
    for (const Side& other : edge)
      if (one.side < other.side && sameCorners(corners(one), corners(other))) {
        advice =
            fmt::format("{} has the same corners as {}: remove it",
                        faceName(keyframe, other.triangle()), faceName(keyframe, one.triangle()));
        offer = offerOf(structure.repair.drop_degenerate, "drop-degenerate");
      }
  fail(structure,
       fmt::format("{}: edge {} belongs to {} faces, the last is {}; at most two are "
                   "accepted: {}",
                   faceName(keyframe, edge.front().triangle()),
                   edgeName(keyframe.mesh, edge.front().key), edge.size(),
                   faceName(keyframe, edge.back().triangle()), advice),
       offer);
}

// A weld can merge two vertices of one face.
void checkCorners(const Structure& structure, const KeyframeMesh& keyframe) {
  const std::vector<Triangle>& triangles = keyframe.mesh.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Triangle& c = triangles[t];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0])
      fail(structure,
           fmt::format("{} uses one vertex for two corners: remove it", faceName(keyframe, t)),
           offerOf(structure.repair.drop_degenerate, "drop-degenerate"));
  }
}

// Would welding join anything?
bool isWeldable(const KeyframeMesh& keyframe) {
  const std::vector<std::vector<Vec3d>> positions{keyframe.mesh.positions};
  const auto joined =
      coincidentOpenVertices(keyframe.mesh.triangles, positions, coincidenceTolerance(positions));
  for (std::uint32_t v = 0; v < joined.size(); ++v)
    if (joined[v] != v) return true;
  return false;
}

[[noreturn]] void failOpen(const Structure& structure, const KeyframeMesh& keyframe,
                           const Side& first, std::size_t count) {
  const bool weldable = !structure.repair.weld && isWeldable(keyframe);
  RepairOffer offer =
      weldable ? offerOf(false, "weld") : offerOf(structure.repair.fill_holes, "fill-holes");
  offer.prefix = "";
  offer.suffix = ", ";
  fail(structure,
       fmt::format("{} has an open edge {}, one of {}; accepted: a closed mesh, lids which close "
                   "it, ",
                   faceName(keyframe, first.triangle()), edgeName(keyframe.mesh, first.key), count),
       std::move(offer), "or membrane = true for an open sheet");
}

void checkBowTies(const Structure& structure, const KeyframeMesh& keyframe,
                  const std::vector<Side>& sides) {
  const TriangleMesh& mesh = keyframe.mesh;
  const std::vector<std::uint32_t> fans = cornerFans(mesh.triangles, sides);
  std::vector<std::uint32_t> first_fan(mesh.positions.size(), kNoSide);
  for (std::uint32_t corner = 0; corner < fans.size(); ++corner) {
    const std::uint32_t v = mesh.triangles[corner / 3][corner % 3];
    if (first_fan[v] == kNoSide) first_fan[v] = fans[corner];
    if (first_fan[v] == fans[corner]) continue;
    fail(structure,
         fmt::format("{} and {} belong to surfaces that meet in the point {} only; accepted: its "
                     "own vertex for each: separate them",
                     faceName(keyframe, first_fan[v] / 3), faceName(keyframe, corner / 3),
                     pointName(mesh, v)),
         offerOf(structure.repair.weld, "weld"));
  }
}

}  // namespace

RepairOffer offerOf(bool has_it, const char* word) {
  return {has_it ? "" : fmt::format("repair = [\"{}\"]", word)};
}

void checkEdges(const Structure& structure, const KeyframeMesh& keyframe) {
  checkCorners(structure, keyframe);
  const std::vector<Side> sides = sortedSides(keyframe.mesh.triangles);
  std::size_t open_count = 0;
  const Side* first_open = nullptr;
  forEachEdge(sides, [&](std::span<const Side> edge) {
    const Side &one = edge.front(), &other = edge.back();
    if (edge.size() > 2) failCrowded(structure, keyframe, edge);
    if (edge.size() == 2 && one.descending == other.descending && !structure.membrane)
      fail(structure,
           fmt::format("{} and {} run their common edge {} in the same direction; faces must be "
                       "oriented consistently: reverse one of them",
                       faceName(keyframe, one.triangle()), faceName(keyframe, other.triangle()),
                       edgeName(keyframe.mesh, one.key)),
           offerOf(structure.repair.orient, "orient"));
    if (edge.size() > 1) return;
    if (first_open == nullptr || one.triangle() < first_open->triangle()) first_open = &one;
    ++open_count;
  });
  if (structure.membrane) return;
  if (open_count > 0) failOpen(structure, keyframe, *first_open, open_count);
  checkBowTies(structure, keyframe, sides);
}

void checkPieces(const Structure& structure, const KeyframeMesh& keyframe) {
  const TriangleMesh& mesh = keyframe.mesh;
  const Pieces pieces = piecesOf(oppositeSides(mesh.triangles, sortedSides(mesh.triangles)));
  if (pieces.count == 1) return;
  const Nesting nesting(mesh.triangles, mesh.positions, pieces);
  std::uint32_t judged = 0;
  for (std::uint32_t piece = 0; piece < pieces.count && judged < kMaxNestedPieces; ++piece) {
    if (nesting.volume(piece) >= 0) continue;
    ++judged;
    int depth = -1;  // entries minus exits of a ray that ends inside it, from far outside
    for (const std::uint32_t outer : nesting.around(piece))
      depth += nesting.volume(outer) > 0 ? 1 : -1;
    if (depth >= 0) continue;
    const std::vector<std::uint32_t>& faces = nesting.trianglesOf(piece);
    fail(structure,
         fmt::format("{} and the {} others of its separate surface look inward, but it "
                     "is not a cavity of another surface: reverse them",
                     faceName(keyframe, faces.front()), faces.size() - 1),
         offerOf(structure.repair.orient, "orient"));
  }
}

}  // namespace echocine
