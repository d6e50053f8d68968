#include "motion/repair/non_manifold_edges.h"

#include <algorithm>
#include <numeric>

#include "motion/mesh/corner_fans.h"
#include "motion/repair/duplicates.h"
#include "motion/repair/edge_pairing.h"
#include "motion/repair/weld.h"

namespace echocine {

namespace {

// Sheets connected by edges of two faces.
struct Sheets {
  Pieces pieces;
  std::vector<double> double_areas;  // in the first keyframe, mesh unit squared
  std::vector<char> open;            // some edge has one face
  std::uint32_t largest = 0;
};

Sheets sheetsOf(const RepairMesh& mesh, const std::vector<Side>& sides) {
  Sheets sheets{piecesOf(oppositeSides(mesh.triangles, sides)), {}, {}};
  sheets.double_areas.resize(sheets.pieces.count);
  sheets.open.resize(sheets.pieces.count);
  const std::vector<Vec3d>& p = mesh.positions.front();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    sheets.double_areas[sheets.pieces.of_triangle[t]] +=
        length(cross(p[c[1]] - p[c[0]], p[c[2]] - p[c[0]]));
  }
  forEachEdge(sides, [&](std::span<const Side> edge) {
    if (edge.size() == 1) sheets.open[sheets.pieces.of_triangle[edge.front().triangle()]] = 1;
  });
  const auto largest = std::max_element(sheets.double_areas.begin(), sheets.double_areas.end());
  sheets.largest = static_cast<std::uint32_t>(largest - sheets.double_areas.begin());
  return sheets;
}

// The sheet to drop at an edge with an odd number of faces, among those with an odd number there;
// the largest sheet if there is no other.
std::uint32_t looseSheet(const Sheets& sheets, std::span<const Side> edge) {
  std::vector<std::uint32_t> at;
  for (const Side& side : edge) at.push_back(sheets.pieces.of_triangle[side.triangle()]);
  std::uint32_t loose = sheets.largest;
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    if (sheets.open[a] != sheets.open[b]) return sheets.open[a] > sheets.open[b];
    if (sheets.double_areas[a] != sheets.double_areas[b])
      return sheets.double_areas[a] < sheets.double_areas[b];
    return a > b;  // the first of equal ones stays
  };
  for (const std::uint32_t sheet : at)
    if (sheet != sheets.largest && std::count(at.begin(), at.end(), sheet) % 2 == 1 &&
        (loose == sheets.largest || before(sheet, loose)))
      loose = sheet;
  return loose;
}

// The sheets to drop at edges with odd numbers of faces: one at each, unless one of its sheets is
// already dropped, which changes the number.
std::vector<char> looseSheets(const Sheets& sheets, const std::vector<Side>& sides) {
  std::vector<char> loose(sheets.pieces.count);
  forEachEdge(sides, [&](std::span<const Side> edge) {
    if (edge.size() < 3 || edge.size() % 2 == 0) return;
    for (const Side& side : edge)
      if (loose[sheets.pieces.of_triangle[side.triangle()]]) return;
    const std::uint32_t sheet = looseSheet(sheets, edge);
    if (sheet != sheets.largest) loose[sheet] = 1;
  });
  return loose;
}

// Drops flaps and inner walls until every edge has an even number of faces or none can be dropped;
// each round drops at least one sheet.
std::size_t dropLooseSheets(RepairMesh& mesh) {
  constexpr int kMostRounds = 32;  // nested flaps; our choice
  const std::size_t before = mesh.triangles.size();
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<Side> sides = sortedSides(mesh.triangles);
    const Sheets sheets = sheetsOf(mesh, sides);
    const std::vector<char> loose = looseSheets(sheets, sides);
    std::vector<Triangle> now;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (loose[sheets.pieces.of_triangle[t]]) continue;
      now.push_back(mesh.triangles[t]);
      kept.push_back(t);
    }
    if (now.size() == mesh.triangles.size()) break;
    replaceTriangles(mesh, std::move(now), kept);
  }
  return before - mesh.triangles.size();
}

}  // namespace

NonManifoldSplit splitNonManifold(RepairMesh& mesh, bool membrane) {
  NonManifoldSplit parted;
  if (!membrane) parted.dropped = dropDuplicates(mesh) + dropLooseSheets(mesh);
  const std::vector<Side> sides = sortedSides(mesh.triangles);
  std::vector<std::uint32_t> opposite = oppositeSides(mesh.triangles, sides);
  forEachEdge(sides, [&](std::span<const Side> edge) {
    if (edge.size() < 3) return;
    ++parted.edges;
    for (const auto& [one, other] : pairsAround(edge, mesh.triangles, mesh.positions.front())) {
      opposite[one] = other;
      opposite[other] = one;
    }
  });
  parted.vertices = splitFans(mesh, cornerFans(mesh.triangles, opposite));
  return parted;
}

}  // namespace echocine
