#include "motion/repair/holes.h"

#include <fmt/format.h>

#include "core/error.h"

namespace echocine {

namespace {

constexpr double kLargestShare = 0.75;

std::vector<char> openSides(std::span<const Triangle> triangles) {
  std::vector<char> open(3 * triangles.size());
  forEachEdge(sortedSides(triangles), [&](std::span<const Side> edge) {
    if (edge.size() == 1) open[edge.front().side] = 1;
  });
  return open;
}

// The open side that ends where `side` starts, around the faces at that vertex; kNoSide if the way
// ends elsewhere.
std::uint32_t nextOpenSide(std::uint32_t side, std::span<const Triangle> triangles,
                           const std::vector<std::uint32_t>& opposite,
                           const std::vector<char>& open) {
  const std::uint32_t vertex = sideStart(triangles, side);
  for (std::size_t step = 0; step < triangles.size(); ++step) {
    const std::uint32_t before = previousSide(side);
    if (open[before]) return before;
    side = opposite[before];
    if (side == kNoSide || sideStart(triangles, side) != vertex) return kNoSide;
  }
  return kNoSide;
}

double areaOf(Vec3d a, Vec3d b, Vec3d c) {
  return length(cross(b - a, c - a)) / 2;
}

double fanArea(const Rim& rim, std::span<const Vec3d> positions) {
  const Vec3d middle = rimMiddle(rim.vertices, positions);
  double area = 0;
  for (std::size_t i = 0; i < rim.vertices.size(); ++i)
    area += areaOf(positions[rim.vertices[i]],
                   positions[rim.vertices[(i + 1) % rim.vertices.size()]], middle);
  return area;
}

// In the first keyframe.
void refuseSheets(const RepairMesh& mesh, const std::vector<Rim>& rims,
                  const std::vector<std::uint32_t>& opposite) {
  const std::vector<Vec3d>& places = mesh.positions.front();
  const Pieces pieces = piecesOf(opposite);
  std::vector<double> areas(pieces.count);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    areas[pieces.of_triangle[t]] +=
        areaOf(places[corners[0]], places[corners[1]], places[corners[2]]);
  }
  for (const Rim& rim : rims) {
    const double share = fanArea(rim, places) / areas[pieces.of_triangle[rim.triangle]];
    if (share <= kLargestShare) continue;
    throw SceneError(fmt::format(
        "{}: the open rim of {} edges at this face would take {:.0f} % of its surface to fill, "
        "{:g} "
        "% is accepted: a sheet is not a closed structure; give lids, or membrane = true",
        mesh.faceName(rim.triangle), rim.vertices.size(), 100 * share, 100 * kLargestShare));
  }
}

void addFace(RepairMesh& mesh, Triangle corners) {
  mesh.triangles.push_back(corners);
  mesh.source.push_back(kNoSource);
}

}  // namespace

std::optional<std::vector<Rim>> findRims(std::span<const Triangle> triangles,
                                         const std::vector<std::uint32_t>& opposite) {
  const std::vector<char> open = openSides(triangles);
  std::vector<char> seen(open.size());
  std::vector<Rim> rims;
  for (std::uint32_t first = 0; first < open.size(); ++first) {
    if (!open[first] || seen[first]) continue;
    Rim rim{{}, first / 3};
    for (std::uint32_t side = first; !seen[side];) {
      seen[side] = 1;
      rim.vertices.push_back(sideEnd(triangles, side));
      const std::uint32_t next = nextOpenSide(side, triangles, opposite, open);
      if (next == kNoSide || (seen[next] && next != first)) return std::nullopt;
      side = next;
    }
    rims.push_back(std::move(rim));
  }
  return rims;
}

Vec3d rimMiddle(std::span<const std::uint32_t> rim, std::span<const Vec3d> positions) {
  const Vec3d origin = positions[rim.front()];
  Vec3d sum;
  double total = 0;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3d a = positions[rim[i]] - origin, b = positions[rim[(i + 1) % rim.size()]] - origin;
    const double edge = length(b - a);
    sum = sum + edge / 2 * (a + b);
    total += edge;
  }
  return total > 0 ? origin + 1 / total * sum : origin;
}

FilledHoles fillHoles(RepairMesh& mesh) {
  const auto opposite = oppositeSides(mesh.triangles, sortedSides(mesh.triangles));
  const std::optional<std::vector<Rim>> rims = findRims(mesh.triangles, opposite);
  if (!rims || rims->empty()) return {};
  refuseSheets(mesh, *rims, opposite);
  const std::size_t before = mesh.triangles.size();
  for (const Rim& rim : *rims) {
    const std::vector<std::uint32_t>& v = rim.vertices;
    if (v.size() == 3) {
      addFace(mesh, {v[0], v[1], v[2]});
      continue;
    }
    const auto middle = static_cast<std::uint32_t>(mesh.vertexCount());
    for (std::vector<Vec3d>& places : mesh.positions) places.push_back(rimMiddle(v, places));
    for (std::size_t i = 0; i < v.size(); ++i) addFace(mesh, {v[i], v[(i + 1) % v.size()], middle});
  }
  return {rims->size(), mesh.triangles.size() - before};
}

}  // namespace echocine
