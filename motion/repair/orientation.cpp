#include "motion/repair/orientation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "motion/mesh/nesting.h"
#include "motion/repair/holes.h"

namespace echocine {

namespace {

// Faces to flip so that each piece has the orientation of its first face.
std::vector<char> turnedToAgree(const RepairMesh& mesh,
                                const std::vector<std::uint32_t>& opposite) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  enum : char { kAsIs, kTurned, kUnseen };
  std::vector<char> turned(triangles.size(), kUnseen);
  std::vector<std::uint32_t> to_visit;
  for (std::uint32_t first = 0; first < triangles.size(); ++first) {
    if (turned[first] != kUnseen) continue;
    turned[first] = kAsIs;
    to_visit.assign(1, first);
    while (!to_visit.empty()) {
      const std::uint32_t t = to_visit.back();
      to_visit.pop_back();
      for (std::uint32_t side = 3 * t; side < 3 * t + 3; ++side) {
        const std::uint32_t across = opposite[side];
        if (across == kNoSide) continue;
        const bool against = sideStart(triangles, side) == sideStart(triangles, across);
        const char wanted = against != (turned[t] == kTurned) ? kTurned : kAsIs;
        char& next = turned[across / 3];
        if (next == kUnseen) {
          next = wanted;
          to_visit.push_back(across / 3);
        } else if (next != wanted) {
          throw SceneError(
              fmt::format("{} and {}: the surface through them has one side only, as a Moebius "
                          "strip, and cannot "
                          "be oriented: remove one of them",
                          mesh.faceName(t), mesh.faceName(across / 3)));
        }
      }
    }
  }
  return turned;
}

// Flips the minority of each piece.
void keepMajority(const Pieces& pieces, std::vector<char>& turned) {
  std::vector<std::int64_t> balance(pieces.count);
  for (std::size_t t = 0; t < turned.size(); ++t)
    balance[pieces.of_triangle[t]] += turned[t] ? 1 : -1;
  for (std::size_t t = 0; t < turned.size(); ++t)
    if (balance[pieces.of_triangle[t]] > 0) turned[t] = !turned[t];
}

// Six times the volume of each piece, with open rims closed by fans.
std::vector<double> pieceVolumes(const RepairMesh& mesh, const std::vector<std::uint32_t>& opposite,
                                 const Pieces& pieces) {
  const std::vector<Vec3d>& places = mesh.positions.front();
  std::vector<Vec3d> reference(pieces.count);
  std::vector<double> volumes(pieces.count);
  for (std::size_t t = mesh.triangles.size(); t-- > 0;)
    reference[pieces.of_triangle[t]] = places[mesh.triangles[t][0]];
  const auto add = [&](std::uint32_t piece, Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d o = reference[piece];
    volumes[piece] += dot(a - o, cross(b - o, c - o));
  };
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    add(pieces.of_triangle[t], places[corners[0]], places[corners[1]], places[corners[2]]);
  }
  const std::optional<std::vector<Rim>> rims = findRims(mesh.triangles, opposite);
  if (!rims) return volumes;
  for (const Rim& rim : *rims) {
    const Vec3d middle = rimMiddle(rim.vertices, places);
    for (std::size_t i = 0; i < rim.vertices.size(); ++i)
      add(pieces.of_triangle[rim.triangle], places[rim.vertices[i]],
          places[rim.vertices[(i + 1) % rim.vertices.size()]], middle);
  }
  return volumes;
}

void turn(Triangle& t) {
  std::swap(t[1], t[2]);
}

// Pieces with the wrong orientation.
std::vector<char> wrongPieces(const RepairMesh& mesh, const std::vector<Side>& sides) {
  const auto opposite = oppositeSides(mesh.triangles, sides);
  const Pieces pieces = piecesOf(opposite);
  if (pieces.count > kMaxNestedPieces)
    throw SceneError(
        fmt::format("{} consists of {} separate surfaces, at most {} can be oriented: "
                    "remove the specks",
                    mesh.parts.front().file.string(), pieces.count, kMaxNestedPieces));
  const std::vector<double> volumes = pieceVolumes(mesh, opposite, pieces);
  const Nesting nesting(mesh.triangles, mesh.positions.front(), pieces);
  std::vector<char> wrong(pieces.count);
  for (std::uint32_t p = 0; p < pieces.count; ++p) {
    const bool solid = pieces.count == 1 || nesting.around(p).size() % 2 == 0;
    wrong[p] = solid ? volumes[p] < 0 : volumes[p] > 0;
  }
  return wrong;
}

}  // namespace

std::size_t orientFaces(RepairMesh& mesh, bool membrane) {
  const std::vector<Triangle> before = mesh.triangles;
  std::vector<Side> sides = sortedSides(mesh.triangles);
  const auto opposite = oppositeSides(mesh.triangles, sides);
  const Pieces pieces = piecesOf(opposite);
  std::vector<char> turned = turnedToAgree(mesh, opposite);
  keepMajority(pieces, turned);
  for (std::size_t t = 0; t < turned.size(); ++t)
    if (turned[t]) turn(mesh.triangles[t]);
  if (!membrane) {
    sides = sortedSides(mesh.triangles);
    const std::vector<char> wrong = wrongPieces(mesh, sides);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      if (wrong[pieces.of_triangle[t]]) turned[t] = !turned[t];
  }
  std::size_t count = 0;
  for (std::size_t t = 0; t < turned.size(); ++t) {
    mesh.triangles[t] = before[t];
    if (turned[t]) turn(mesh.triangles[t]);
    count += static_cast<std::size_t>(turned[t]);
  }
  return count;
}

}  // namespace echocine
