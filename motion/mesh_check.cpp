#include "motion/mesh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "core/error.h"

namespace echocine {

namespace {

// Our choice: smaller is a wrong unit or a speck, larger is no part of a body.
constexpr double kMinExtentMetres = 1e-3;
constexpr double kMaxExtentMetres = 2.0;

const MeshPart& partOfTriangle(const KeyframeMesh& keyframe, std::size_t triangle) {
  const MeshPart* found = &keyframe.parts.front();
  for (const MeshPart& part : keyframe.parts)
    if (part.first_triangle <= triangle) found = &part;
  return *found;
}

// "lid.obj: face 12", numbered as in that file.
std::string faceName(const KeyframeMesh& keyframe, std::size_t triangle) {
  const MeshPart& part = partOfTriangle(keyframe, triangle);
  return fmt::format("{}: face {}", part.file.string(), triangle - part.first_triangle + 1);
}

// Vertices are named by where they are: in a joined mesh their numbers belong to different files.
std::string pointName(const TriangleMesh& mesh, std::uint32_t vertex) {
  const Vec3d p = mesh.positions[vertex];
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

[[noreturn]] void fail(const Structure& structure, const std::string& what) {
  throw SceneError(atPlace(structure.place, fmt::format("{}: {}", structure.name, what)));
}

// One side of a triangle; both sides of a common edge have the same key.
struct Side {
  std::uint64_t key;  // lower vertex, higher vertex
  std::uint32_t triangle;
  bool descending;  // runs from the higher to the lower vertex
};

std::vector<Side> sortedSides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back(
          {std::min(a, b) << 32 | std::max(a, b), static_cast<std::uint32_t>(t), a > b});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  });
  return sides;
}

std::string edgeName(const TriangleMesh& mesh, std::uint64_t key) {
  return fmt::format("{} - {}", pointName(mesh, static_cast<std::uint32_t>(key >> 32)),
                     pointName(mesh, static_cast<std::uint32_t>(key)));
}

void checkEdges(const Structure& structure, const KeyframeMesh& keyframe) {
  const std::vector<Side> sides = sortedSides(keyframe.mesh);
  std::size_t open_count = 0;
  const Side* first_open = nullptr;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].key == sides[begin].key) ++end;
    const Side &one = sides[begin], &other = sides[end - 1];
    if (end - begin > 2)
      fail(structure,
           fmt::format("{}: edge {} belongs to {} faces, the last is {}; at most two are "
                       "accepted: remove duplicate faces and split surfaces that meet",
                       faceName(keyframe, one.triangle), edgeName(keyframe.mesh, one.key),
                       end - begin, faceName(keyframe, other.triangle)));
    if (end - begin == 2 && one.descending == other.descending)
      fail(structure,
           fmt::format("{} and {} run their common edge {} in the same direction; faces "
                       "must be oriented alike: reverse one of them",
                       faceName(keyframe, one.triangle), faceName(keyframe, other.triangle),
                       edgeName(keyframe.mesh, one.key)));
    if (end - begin > 1) continue;
    if (first_open == nullptr || one.triangle < first_open->triangle) first_open = &one;
    ++open_count;
  }
  if (open_count > 0 && !structure.membrane)
    fail(structure,
         fmt::format("{} has an open edge {}, one of {}; accepted: a closed mesh, lids which close "
                     "it, or membrane = true for an open sheet",
                     faceName(keyframe, first_open->triangle),
                     edgeName(keyframe.mesh, first_open->key), open_count));
}

void checkSameFaces(const Structure& structure, const KeyframeMesh& first,
                    const KeyframeMesh& other) {
  const std::string first_file = first.parts.front().file.string();
  const std::string other_file = other.parts.front().file.string();
  if (first.mesh.positions.size() != other.mesh.positions.size())
    fail(structure,
         fmt::format("{} has {} vertices, {} has {}{}; every keyframe must have the same",
                     other_file, other.mesh.positions.size(), first_file,
                     first.mesh.positions.size(), other.parts.size() > 1 ? " (lids joined)" : ""));
  if (first.mesh.triangles.size() != other.mesh.triangles.size())
    fail(structure,
         fmt::format("{} has {} faces, {} has {}; every keyframe must have the same", other_file,
                     other.mesh.triangles.size(), first_file, first.mesh.triangles.size()));
  for (std::size_t t = 0; t < first.mesh.triangles.size(); ++t)
    if (first.mesh.triangles[t] != other.mesh.triangles[t])
      fail(structure, fmt::format("{} differs from the same face of {}; every keyframe must have "
                                  "the same faces",
                                  faceName(other, t), first_file));
}

void checkExtent(const Structure& structure, const KeyframeMesh& keyframe, double mesh_unit_m) {
  Vec3d low = keyframe.mesh.positions.front(), high = low;
  for (const Vec3d& p : keyframe.mesh.positions) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3d size = high - low;
  const double extent = std::max({size.x, size.y, size.z});
  const double extent_m = extent * mesh_unit_m;
  if (!(extent_m >= kMinExtentMetres && extent_m <= kMaxExtentMetres))
    fail(structure, fmt::format("{} measures {:.4g} mesh units, which motion.mesh_unit makes "
                                "{:.4g} m; 1 mm to 2 m is accepted: mend motion.mesh_unit",
                                keyframe.parts.front().file.string(), extent, extent_m));
}

void checkVolume(const Structure& structure, const KeyframeMesh& keyframe, bool is_first) {
  const double volume = signedVolume(keyframe.mesh);
  if (volume > 0) return;
  fail(structure,
       fmt::format("{} encloses a volume of {:.4g} cubic mesh units: {}",
                   keyframe.parts.front().file.string(), volume,
                   is_first ? "its faces look inward; reverse the vertex order of every face"
                            : "this keyframe is turned inside out or mirrored; mend its vertices"));
}

}  // namespace

void checkFile(const TriangleMesh& mesh, const std::filesystem::path& file) {
  const auto fail_file = [&](const std::string& what) {
    throw SceneError(fmt::format("{}: {}", file.string(), what));
  };
  if (mesh.positions.empty() || mesh.triangles.empty())
    fail_file(fmt::format("a surface is needed, the file has {} vertices and {} faces",
                          mesh.positions.size(), mesh.triangles.size()));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (!isFinite(mesh.positions[v]))
      fail_file(fmt::format("vertex {} has a coordinate that is not finite", v + 1));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    for (const std::uint32_t v : corners)
      if (v >= mesh.positions.size())
        fail_file(fmt::format("face {} uses vertex {}, the file has {} vertices", t + 1,
                              std::uint64_t{v} + 1, mesh.positions.size()));
    for (std::size_t k = 0; k < 3; ++k)
      if (corners[k] == corners[(k + 1) % 3])
        fail_file(
            fmt::format("face {} uses vertex {} twice; remove the face", t + 1, corners[k] + 1));
  }
}

void checkKeyframes(const Structure& structure, std::span<const KeyframeMesh> keyframes,
                    double mesh_unit_m) {
  const KeyframeMesh& first = keyframes.front();
  for (const KeyframeMesh& keyframe : keyframes.subspan(1))
    checkSameFaces(structure, first, keyframe);
  checkEdges(structure, first);
  for (const KeyframeMesh& keyframe : keyframes) {
    checkExtent(structure, keyframe, mesh_unit_m);
    if (!structure.membrane) checkVolume(structure, keyframe, &keyframe == &first);
  }
}

double signedVolume(const TriangleMesh& mesh) {
  const Vec3d reference = mesh.positions[mesh.triangles.front()[0]];
  double six_volumes = 0;
  for (const Triangle& t : mesh.triangles)
    six_volumes += dot(mesh.positions[t[0]] - reference,
                       cross(mesh.positions[t[1]] - reference, mesh.positions[t[2]] - reference));
  return six_volumes / 6.0;
}

}  // namespace echocine
