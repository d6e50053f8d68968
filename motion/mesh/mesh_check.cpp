#include "motion/mesh/mesh_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "core/error.h"
#include "motion/mesh/surface_check.h"
#include "motion/mesh/surface_measure.h"

namespace echocine {

namespace {

// Our choice: smaller is a wrong unit or a speck, larger is not part of a body.
constexpr double kMinExtentMetres = 1e-3;
constexpr double kMaxExtentMetres = 2.0;

[[noreturn]] void fail(const Structure& structure, const std::string& what) {
  throw SceneError(atPlace(structure.place, fmt::format("{}: {}", structure.name, what)));
}

// Vertices of a part that are not at the place of an earlier part's.
std::size_t ownVertices(const KeyframeMesh& keyframe, std::size_t part) {
  const std::size_t end = part + 1 < keyframe.parts.size() ? keyframe.parts[part + 1].first_vertex
                                                           : keyframe.mesh.positions.size();
  return end - keyframe.parts[part].first_vertex;
}

// The same number of vertices and the same faces in two keyframes.
void checkSameFaces(const Structure& structure, const KeyframeMesh& first,
                    const KeyframeMesh& other) {
  const std::string first_file = first.parts.front().file.string();
  const std::string other_file = other.parts.front().file.string();
  if (first.mesh.positions.size() != other.mesh.positions.size()) {
    const std::string all_same = "every keyframe must have the same";
    for (std::size_t p = 0; p < first.parts.size() && first.parts.size() == other.parts.size(); ++p)
      if (ownVertices(first, p) != ownVertices(other, p))
        fail(structure,
             p == 0
                 ? fmt::format("{} has {} vertices, {} has {}; {}", other_file,
                               ownVertices(other, p), first_file, ownVertices(first, p), all_same)
                 : fmt::format("lid {} adds {} vertices to its keyframe, {} adds {}; {}: a "
                               "lid's vertex joins the mesh where both have exactly the same "
                               "coordinates",
                               other.parts[p].file.string(), ownVertices(other, p),
                               first.parts[p].file.string(), ownVertices(first, p), all_same));
    fail(structure, fmt::format("{} has {} vertices with its lids, {} has {}; {}", other_file,
                                other.mesh.positions.size(), first_file,
                                first.mesh.positions.size(), all_same));
  }
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

// Creases and corners belong to the faces: the first keyframe's apply to all. The others may all
// omit them.
void checkSameTags(const Structure& structure, std::span<const KeyframeMesh> keyframes) {
  const KeyframeMesh* given = &keyframes.front();  // with which the others must agree
  for (const KeyframeMesh& other : keyframes.subspan(1)) {
    const bool leaves_out =
        given == &keyframes.front() && &other == &keyframes[1] && other.mesh.tags.empty();
    if (leaves_out) given = &other;
    if (other.mesh.tags == given->mesh.tags) continue;
    fail(structure,
         fmt::format("{} has other creases or corners than {}; accepted: the same `t` lines in "
                     "every keyframe, or in the first one only",
                     other.parts.front().file.string(), given->parts.front().file.string()));
  }
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
    fail(structure,
         fmt::format(
             "{} measures {:.4g} mesh units, "
             "{:.4g} m by motion.mesh_unit; 1 mm to 2 m is accepted: correct motion.mesh_unit or "
             "motion.mesh_scale (a chamber of "
             "80 mm takes {:.2g} mm per mesh unit)",
             keyframe.parts.front().file.string(), extent, extent_m, 80 / extent));
}

void checkVolume(const Structure& structure, const KeyframeMesh& keyframe, bool is_first) {
  const double volume = signedVolume(keyframe.mesh);
  if (volume > 0) return;
  const std::string encloses = fmt::format("{} encloses a volume of {:.4g} cubic mesh units: ",
                                           keyframe.parts.front().file.string(), volume);
  if (!is_first)
    fail(structure,
         encloses + "this keyframe is turned inside out or mirrored; correct its vertices");
  throw MeshFault(
      atPlace(structure.place,
              fmt::format("{}: {}its faces look inward; reverse the vertex order of every face",
                          structure.name, encloses)),
      offerOf(structure.repair.orient, "orient"));
}

}  // namespace

void checkFile(const TriangleMesh& mesh, const std::filesystem::path& file, bool degenerate) {
  const auto fail_file = [&](const std::string& what) {
    throw SceneError(fmt::format("{}: {}", file.string(), what));
  };
  if (mesh.positions.empty() || mesh.triangles.empty())
    fail_file(fmt::format("a surface is needed, the file has {} vertices and {} faces",
                          mesh.positions.size(), mesh.triangles.size()));
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    if (!isFinite(mesh.positions[v]))
      fail_file(fmt::format("vertex {} has a coordinate that is not finite; correct it", v + 1));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const std::size_t face = fileFace(mesh.faces, t) + 1;
    for (const std::uint32_t v : corners)
      if (v >= mesh.positions.size())
        fail_file(fmt::format("face {} uses vertex {}, the file has {} vertices; correct the face",
                              face, std::uint64_t{v} + 1, mesh.positions.size()));
    for (std::size_t k = 0; k < 3 && !degenerate; ++k)
      if (corners[k] == corners[(k + 1) % 3])
        throw MeshFault(fmt::format("{}: face {} uses vertex {} twice; remove the face",
                                    file.string(), face, corners[k] + 1),
                        offerOf(false, "drop-degenerate"));
  }
}

void checkSameConnectivity(const Structure& structure, std::span<const KeyframeMesh> keyframes) {
  for (const KeyframeMesh& keyframe : keyframes.subspan(1))
    checkSameFaces(structure, keyframes.front(), keyframe);
}

void checkKeyframes(const Structure& structure, std::span<const KeyframeMesh> keyframes,
                    double mesh_unit_m) {
  const KeyframeMesh& first = keyframes.front();
  checkSameConnectivity(structure, keyframes);
  checkSameTags(structure, keyframes);
  checkEdges(structure, first);
  for (const KeyframeMesh& keyframe : keyframes) {
    checkExtent(structure, keyframe, mesh_unit_m);
    if (!structure.membrane) checkVolume(structure, keyframe, &keyframe == &first);
  }
  if (!structure.membrane) checkPieces(structure, first);
}

std::string faceName(std::span<const MeshPart> parts, std::size_t triangle) {
  const MeshPart* found = &parts.front();
  for (const MeshPart& part : parts)
    if (part.first_triangle <= triangle) found = &part;
  const std::size_t face = triangle - found->first_triangle;
  if (found->filled)
    return fmt::format("{}: face {} of those that fill its holes", found->file.string(), face + 1);
  return fmt::format("{}: face {}", found->file.string(), fileFace(found->faces, face) + 1);
}

double signedVolume(const TriangleMesh& mesh) {
  return enclosedVolume(mesh.triangles, [&](std::uint32_t v) { return mesh.positions[v]; });
}

}  // namespace echocine
