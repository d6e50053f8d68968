#include "motion/mesh/mesh_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <unordered_map>

#include "core/error.h"
#include "core/file.h"
#include "motion/mesh/mesh_check.h"
#include "motion/mesh/mesh_fault.h"
#include "motion/mesh/npz_meshes.h"
#include "motion/mesh/obj_reader.h"
#include "motion/mesh/openmesh_reader.h"
#include "motion/mesh/tag_join.h"
#include "scene/npz_keyframe.h"

namespace echocine {

namespace {

// Approximate size of a text mesh at the vertex limit.
constexpr std::size_t kMaxFileBytes = std::size_t{2} << 30;

// Zero is added so that -0 and 0, which compare equal, hash equal.
struct PositionHash {
  std::size_t operator()(const Vec3d& p) const {
    std::uint64_t hash = 0;
    for (const double coordinate : {p.x, p.y, p.z})
      hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate + 0.0)) * 0x9E3779B97F4A7C15u;
    return hash ^ (hash >> 29);
  }
};

using VertexAt = std::unordered_map<Vec3d, std::uint32_t, PositionHash>;

std::string extensionOf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension.empty() ? extension : extension.substr(1);
}

// `degenerate`: accepts faces with two corners at the same place.
void appendLid(const TriangleMesh& lid, const std::filesystem::path& file, bool degenerate,
               VertexAt& vertex_at, TriangleMesh& mesh) {
  std::vector<std::uint32_t> joined_from_lid;
  joined_from_lid.reserve(lid.positions.size());
  for (const Vec3d& position : lid.positions) {
    const auto next = static_cast<std::uint32_t>(mesh.positions.size());
    const auto [entry, is_new] = vertex_at.try_emplace(position, next);
    if (is_new) mesh.positions.push_back(position);
    joined_from_lid.push_back(entry->second);
  }
  for (std::size_t t = 0; t < lid.triangles.size(); ++t) {
    Triangle corners = lid.triangles[t];
    for (std::uint32_t& corner : corners) corner = joined_from_lid[corner];
    const bool collapsed =
        corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    if (collapsed && !degenerate)
      throw MeshFault(
          fmt::format("{}: face {} has two corners at the same place; a lid cannot be joined with "
                      "such a face: remove it",
                      file.string(), fileFace(lid.faces, t) + 1),
          {"repair = [\"drop-degenerate\"]"});
    mesh.triangles.push_back(corners);
  }
  joinTags(lid.tags, joined_from_lid, file, mesh.tags);
}

template <typename T>
void addBytes(const std::vector<T>& values, Sha256& digest) {
  digest.update(std::as_bytes(std::span(values)));
}

void addMesh(const TriangleMesh& mesh, Sha256& digest) {
  addBytes(mesh.positions, digest);
  addBytes(mesh.triangles, digest);
  addBytes(mesh.tags.edges, digest);
  addBytes(mesh.tags.vertices, digest);
}

bool inMemory(const Keyframe& keyframe, std::size_t file) {
  return file < keyframe.meshes.size() && keyframe.meshes[file];
}

std::string extensionOfMesh(const std::filesystem::path& file) {
  std::string extension = extensionOf(file);
  if (extension != "obj" && extension != "ply" && extension != "off" && extension != "stl")
    throw SceneError(fmt::format(
        "{}: unknown kind of mesh file; obj, ply, off, stl and npz are accepted", file.string()));
  return extension;
}

TriangleMesh parseMesh(const std::filesystem::path& file, const std::string& extension,
                       const std::string& bytes) {
  if (bytes.empty()) throw SceneError(fmt::format("{}: the file is empty", file.string()));
  if (extension != "obj") {
    try {
      return parseWithOpenMesh(bytes, extension);
    } catch (const SceneError& error) {
      throw SceneError(fmt::format("{}: {}", file.string(), error.what()));
    }
  }
  try {
    return parseObj(bytes);
  } catch (const SceneError& error) {
    throw SceneError(fmt::format("{}:{}", file.string(), error.what()));
  }
}

TriangleMesh readMesh(const std::filesystem::path& file, std::string& bytes) {
  const std::string extension = extensionOfMesh(file);
  bytes = readTextFile(file, kMaxFileBytes);
  return parseMesh(file, extension, bytes);
}

// From memory, from a .npz file, or from a file of its own.
TriangleMesh meshOf(const Keyframe& keyframe, std::size_t file, const NpzFiles& npz,
                    std::string& text) {
  if (inMemory(keyframe, file)) return *keyframe.meshes[file];
  const std::filesystem::path& name = keyframe.files[file];
  return npzKeyframeOf(name) ? npz.mesh(name, text) : readMesh(name, text);
}

KeyframeMesh joinFiles(const Keyframe& keyframe, bool degenerate, const NpzFiles& npz,
                       std::vector<std::string>& texts) {
  texts.assign(keyframe.files.size(), {});
  KeyframeMesh joined;
  VertexAt vertex_at;
  for (std::size_t i = 0; i < keyframe.files.size(); ++i) {
    const std::filesystem::path& file = keyframe.files[i];
    TriangleMesh mesh = meshOf(keyframe, i, npz, texts[i]);
    checkFile(mesh, file, degenerate);
    joined.parts.push_back(
        {file, joined.mesh.triangles.size(), joined.mesh.positions.size(), std::move(mesh.faces)});
    if (joined.parts.size() > 1) {
      mesh.faces = joined.parts.back().faces;
      appendLid(mesh, file, degenerate, vertex_at, joined.mesh);
      continue;
    }
    joined.mesh = std::move(mesh);
    joined.mesh.faces.clear();
    if (keyframe.files.size() == 1) continue;
    for (std::size_t v = 0; v < joined.mesh.positions.size(); ++v)
      vertex_at.try_emplace(joined.mesh.positions[v], static_cast<std::uint32_t>(v));
  }
  return joined;
}

}  // namespace

TriangleMesh readMesh(const std::filesystem::path& file, Sha256& digest) {
  std::string bytes;
  TriangleMesh mesh = readMesh(file, bytes);
  digest.update(std::string_view(bytes));
  return mesh;
}

KeyframeMesh readKeyframe(const Keyframe& keyframe, const Structure& structure, Sha256& digest) {
  std::vector<std::string> texts;
  Structure alone;
  alone.keyframes = {keyframe};
  KeyframeMesh mesh = readKeyframe(keyframe, structure, NpzFiles({&alone, 1}), texts);
  addToDigest(keyframe, texts, digest);
  return mesh;
}

KeyframeMesh readKeyframe(const Keyframe& keyframe, const Structure& structure, const NpzFiles& npz,
                          std::vector<std::string>& texts) {
  try {
    return joinFiles(keyframe, structure.repair.drop_degenerate, npz, texts);
  } catch (const MeshFault& fault) {
    throw fault.at(atPlace(structure.place, structure.name + ": "));
  } catch (const SceneError& error) {
    throw SceneError(atPlace(structure.place, fmt::format("{}: {}", structure.name, error.what())));
  }
}

void addToDigest(const Keyframe& keyframe, std::span<const std::string> texts, Sha256& digest) {
  for (std::size_t i = 0; i < keyframe.files.size(); ++i)
    if (inMemory(keyframe, i))
      addMesh(*keyframe.meshes[i], digest);
    else
      digest.update(std::string_view(texts[i]));
}

}  // namespace echocine
