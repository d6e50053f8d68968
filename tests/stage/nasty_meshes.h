#pragma once
// Makers of nasty meshes, all from a ball of 512 faces, and the checks and repairs of MeshMotion on
// meshes in memory.

#include <algorithm>
#include <random>

#include "motion/mesh/mesh_check.h"
#include "motion/repair/mesh_repair.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {

inline constexpr Repairs kWeld{.weld = true}, kDrop{.drop_degenerate = true},
    kOrient{.orient = true}, kFill{.fill_holes = true},
    kAll{.weld = true, .drop_degenerate = true, .orient = true, .fill_holes = true};

inline TriangleMesh ball() {
  return sphere(2, 3);
}

inline TriangleMesh flipped(TriangleMesh mesh, std::size_t every) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += every)
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return mesh;
}

inline TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) out.positions.push_back(mesh.positions[v]);
    const auto last = static_cast<std::uint32_t>(out.positions.size());
    out.triangles.push_back({last - 3, last - 2, last - 1});
  }
  return out;
}

// Every place computed a little differently, as single precision does.
inline TriangleMesh shaken(TriangleMesh mesh) {
  std::mt19937 random(3);
  for (Vec3d& p : mesh.positions)
    for (double* c : {&p.x, &p.y, &p.z})
      *c += (static_cast<double>(random() % 3) - 1) * 2.0 / (1 << 23);
  return mesh;
}

inline TriangleMesh without(TriangleMesh mesh, std::size_t first, std::size_t count) {
  const auto begin = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first);
  mesh.triangles.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  return mesh;
}

inline TriangleMesh withFaces(TriangleMesh mesh, const std::vector<Triangle>& faces) {
  mesh.triangles.insert(mesh.triangles.end(), faces.begin(), faces.end());
  return mesh;
}

inline TriangleMesh both(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh out = a;
  const auto offset = static_cast<std::uint32_t>(a.positions.size());
  out.positions.insert(out.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles)
    out.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return out;
}

inline TriangleMesh moved(TriangleMesh mesh, Vec3d by) {
  for (Vec3d& p : mesh.positions) p = p + by;
  return mesh;
}

// A fin on edge (a, b) of the first face: one triangle with both its sides.
inline TriangleMesh finned(TriangleMesh mesh) {
  const auto tip = static_cast<std::uint32_t>(mesh.positions.size());
  const Triangle t = mesh.triangles[0];
  mesh.positions.push_back(1.5 * mesh.positions[t[0]]);
  return withFaces(mesh, {{t[0], t[1], tip}, {t[1], t[0], tip}});
}

// Edge (a, b) of the first face is cut at its middle, in that face only: the other side keeps it,
// and a face without area stands between both.
inline TriangleMesh withFlatFace(TriangleMesh mesh) {
  const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
  const Triangle t = mesh.triangles[0];
  mesh.positions.push_back(0.5 * (mesh.positions[t[0]] + mesh.positions[t[1]]));
  mesh.triangles[0] = {t[0], middle, t[2]};
  return withFaces(mesh, {{middle, t[1], t[2]}, {t[0], t[1], middle}});
}

// Vertex a of the first face is doubled: its fan is cut open there and the slit filled with faces
// without area.
inline TriangleMesh withNeedles(TriangleMesh mesh) {
  const std::uint32_t a = mesh.triangles[0][0];
  const auto twin = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(Vec3d{mesh.positions[a]});
  Triangle& t = mesh.triangles[0];
  const std::uint32_t b = t[1], c = t[2];
  t = {twin, b, c};
  return withFaces(mesh, {{a, b, twin}, {twin, c, a}});
}

// Two balls that share one vertex.
inline TriangleMesh bowTie() {
  TriangleMesh two = both(octahedron(2), octahedron(2, {4, 0, 0}));
  for (Triangle& t : two.triangles)
    for (std::uint32_t& v : t)
      if (v == 7) v = 0;  // (2, 0, 0) of both
  return two;
}

inline TriangleMesh moebius() {
  TriangleMesh strip;
  constexpr std::uint32_t n = 12;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double turn = 2 * std::numbers::pi * i / n;
    for (const double side : {-0.5, 0.5})
      strip.positions.push_back({(2 + side * std::cos(turn / 2)) * std::cos(turn),
                                 (2 + side * std::cos(turn / 2)) * std::sin(turn),
                                 side * std::sin(turn / 2)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const std::uint32_t c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    strip.triangles.insert(strip.triangles.end(), {{a, b, c}, {b, d, c}});
  }
  return strip;
}

inline std::string objPlace() {
  return "scene.toml:7: structure.keyframes: ball: ";
}

inline Structure named(const Repairs& repair, bool membrane = false) {
  Structure structure = structureOf({});
  structure.repair = repair;
  structure.membrane = membrane;
  return structure;
}

// Reads nothing: the same checks and repairs as MeshMotion's, on meshes in memory.
inline std::string mend(const Structure& structure, std::vector<KeyframeMesh>& keyframes) {
  for (const KeyframeMesh& keyframe : keyframes)
    checkFile(keyframe.mesh, keyframe.parts.front().file, structure.repair.drop_degenerate);
  const std::string note = repairKeyframes(structure, keyframes);
  checkKeyframes(structure, keyframes, 0.01);
  return note;
}

inline std::vector<KeyframeMesh> keyframesOf(const std::vector<TriangleMesh>& meshes) {
  std::vector<KeyframeMesh> keyframes;
  for (const TriangleMesh& mesh : meshes)
    keyframes.push_back(
        {mesh, {{std::string(1, static_cast<char>('a' + keyframes.size())) + ".obj"}}});
  return keyframes;
}

}  // namespace echocine::motion_test
