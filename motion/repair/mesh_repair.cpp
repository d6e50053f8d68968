#include "motion/repair/mesh_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/error.h"
#include "motion/mesh/coincidence.h"
#include "motion/mesh/mesh_check.h"
#include "motion/repair/degenerate.h"
#include "motion/repair/holes.h"
#include "motion/repair/non_manifold_edges.h"
#include "motion/repair/orientation.h"
#include "motion/repair/weld.h"

namespace echocine {

namespace {

struct RepairCounts {
  std::size_t welded = 0, split = 0, unused = 0;
  NonManifoldSplit parted;
  DroppedFaces dropped;
  std::size_t turned = 0;
  FilledHoles filled;
};

RepairMesh takenFrom(std::vector<KeyframeMesh>& keyframes) {
  RepairMesh mesh;
  mesh.triangles = keyframes.front().mesh.triangles;
  mesh.source.resize(mesh.triangles.size());
  std::iota(mesh.source.begin(), mesh.source.end(), 0u);
  mesh.parts = keyframes.front().parts;
  for (KeyframeMesh& keyframe : keyframes) {
    mesh.positions.push_back(std::move(keyframe.mesh.positions));
    mesh.tags.push_back(std::move(keyframe.mesh.tags));
  }
  mesh.tolerance = coincidenceTolerance(mesh.positions);
  return mesh;
}

RepairCounts repair(const Repairs& asked, bool membrane, RepairMesh& mesh) {
  RepairCounts counts;
  if (asked.weld) counts.welded = weldOpenEdges(mesh);
  if (asked.drop_degenerate) counts.dropped = dropDegenerate(mesh);
  if (mesh.triangles.empty())
    throw SceneError(
        fmt::format("{}: no face is left when those without area and both sides of "
                    "fins are dropped: give another mesh",
                    mesh.parts.front().file.string()));
  // Dropping faces may leave a bow tie, so this part of welding follows it.
  if (asked.weld) counts.split = splitBowTies(mesh);
  if (asked.orient) counts.turned = orientFaces(mesh, membrane);
  if (asked.split) counts.parted = splitNonManifold(mesh, membrane);
  // Splitting changes the connections of sheets.
  if (asked.split && asked.orient) counts.turned += orientFaces(mesh, membrane);
  const std::size_t gone = dropUnusedVertices(mesh);
  if (asked.weld || asked.drop_degenerate || asked.split)
    counts.unused = gone - std::min(gone, counts.welded);
  if (asked.fill_holes) counts.filled = fillHoles(mesh);
  return counts;
}

// The parts of a keyframe with their remaining faces.
std::vector<MeshPart> partsLeft(const std::vector<MeshPart>& before, const RepairMesh& mesh,
                                std::size_t triangles_before) {
  std::vector<MeshPart> parts;
  std::size_t next = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const MeshPart& old = before[p];
    const std::size_t end = p + 1 < before.size() ? before[p + 1].first_triangle : triangles_before;
    MeshPart part{old.file, next, std::min(old.first_vertex, mesh.vertexCount())};
    for (; next < mesh.source.size() && mesh.source[next] < end; ++next)
      part.faces.push_back(
          static_cast<std::uint32_t>(fileFace(old.faces, mesh.source[next] - old.first_triangle)));
    if (part.faces.size() == end - old.first_triangle) part.faces = old.faces;
    parts.push_back(std::move(part));
  }
  if (next < mesh.triangles.size())
    parts.push_back({before.front().file, next, mesh.vertexCount(), {}, true});
  return parts;
}

void giveBack(RepairMesh& mesh, std::vector<KeyframeMesh>& keyframes) {
  const std::size_t triangles_before = keyframes.front().mesh.triangles.size();
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    keyframes[k].parts = partsLeft(keyframes[k].parts, mesh, triangles_before);
    keyframes[k].mesh.positions = std::move(mesh.positions[k]);
    keyframes[k].mesh.tags = std::move(mesh.tags[k]);
    keyframes[k].mesh.triangles = mesh.triangles;
  }
}

bool everyVertexIsUsed(const TriangleMesh& mesh) {
  std::vector<char> used(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  return std::all_of(used.begin(), used.end(), [](char u) { return u != 0; });
}

// Do two faces anywhere have the same direction along their common edge?
bool windsBothWays(std::span<const Triangle> triangles) {
  bool both = false;
  forEachEdge(sortedSides(triangles), [&](std::span<const Side> edge) {
    both = both || (edge.size() == 2 && edge.front().descending == edge.back().descending);
  });
  return both;
}

std::string words(const RepairCounts& counts) {
  std::string text;
  const auto add = [&](std::size_t count, const char* one, const char* many, const char* done) {
    if (count == 0) return;
    text +=
        fmt::format("{}{} {} {}", text.empty() ? "" : ", ", count, count == 1 ? one : many, done);
  };
  add(counts.welded, "vertex", "vertices", "welded");
  add(counts.dropped.collapsed, "face without area", "faces without area", "dropped");
  add(counts.dropped.duplicates, "duplicate face", "duplicate faces", "dropped");
  add(counts.dropped.flipped, "flat face", "flat faces", "repaired by flipping an edge");
  add(counts.split, "vertex", "vertices", "added where surfaces met in a point");
  add(counts.parted.dropped, "face", "faces", "dropped that enclosed no volume");
  add(counts.parted.edges, "edge of more than two faces", "edges of more than two faces", "split");
  add(counts.parted.vertices, "vertex", "vertices", "added where sheets were separated");
  add(counts.unused, "unused vertex", "unused vertices", "dropped");
  add(counts.turned, "face", "faces", "turned");
  add(counts.filled.holes, "hole", "holes", "filled");
  if (counts.filled.holes > 0)
    text += fmt::format(" ({} face{})", counts.filled.faces, counts.filled.faces == 1 ? "" : "s");
  return text;
}

}  // namespace

std::string repairKeyframes(const Structure& structure, std::vector<KeyframeMesh>& keyframes) {
  const TriangleMesh& first = keyframes.front().mesh;
  const bool winds = structure.membrane && windsBothWays(first.triangles);
  if (!structure.repair.any() && !winds && everyVertexIsUsed(first)) return "";
  checkSameConnectivity(structure, keyframes);
  RepairMesh mesh = takenFrom(keyframes);
  RepairCounts counts;
  try {
    counts = repair(structure.repair, structure.membrane, mesh);
    // A membrane has no correct side, but normals and smoothing need a consistent one. Not
    // reported.
    if (winds && !structure.repair.orient) orientFaces(mesh, true);
  } catch (const SceneError& error) {
    throw SceneError(atPlace(structure.place, fmt::format("{}: {}", structure.name, error.what())));
  }
  giveBack(mesh, keyframes);
  const std::string done = words(counts);
  return done.empty()
             ? ""
             : atPlace(structure.place, fmt::format("{}: repaired: {}", structure.name, done));
}

}  // namespace echocine
