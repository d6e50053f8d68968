#include "motion/mesh/npz_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "core/error.h"
#include "core/hash.h"
#include "core/npz_reader.h"
#include "core/parallel.h"
#include "motion/mesh/settle_tags.h"
#include "scene/npz_keyframe.h"

namespace echocine {

namespace {

using Shape = std::vector<std::size_t>;

constexpr const char* kArrays[] = {"points",           "faces",   "corners",
                                   "corner_sharpness", "creases", "crease_sharpness"};

// A misspelt or unsupported array must not be ignored silently.
void refuseOtherArrays(const NpzReader& npz) {
  for (const std::string& name : npz.names())
    if (std::find(std::begin(kArrays), std::end(kArrays), name) == std::end(kArrays))
      npz.fail(fmt::format("has the array \"{}\", accepted: {}", name, fmt::join(kArrays, ", ")));
}

// Headers are compared before data is read.
void checkShape(const NpzReader& npz, const char* array, const Shape& shape, const Shape& wanted,
                const char* accepted) {
  const bool fits =
      shape.size() == wanted.size() &&
      std::equal(shape.begin(), shape.end(), wanted.begin(),
                 [](std::size_t n, std::size_t want) { return want == 0 ? n > 0 : n == want; });
  if (!fits) npz.fail(fmt::format("{} is {}, accepted: {}", array, shapeText(shape), accepted));
}

void readPoints(const NpzReader& npz, NpzMeshes& meshes) {
  const Shape declared = npz.header("points").shape;
  checkShape(npz, "points", declared, {0, 0, 3}, "(K, V, 3), K keyframes of V vertices");
  if (declared[1] > kMaxMeshVertices)
    npz.fail(
        fmt::format("points has {} vertices, accepted: up to {}", declared[1], kMaxMeshVertices));
  Shape shape;
  meshes.points = npz.numbers("points", shape);
  meshes.keyframes = shape[0];
  meshes.vertices = shape[1];
  const auto bad = std::find_if(meshes.points.begin(), meshes.points.end(),
                                [](double value) { return !std::isfinite(value); });
  if (bad == meshes.points.end()) return;
  const auto at = static_cast<std::size_t>(bad - meshes.points.begin());
  npz.fail(fmt::format("points[{}, {}, {}] is {}, accepted: finite numbers",
                       at / (3 * meshes.vertices), at / 3 % meshes.vertices, at % 3, *bad));
}

// Rows of vertices, such as faces. `width` 1: a list.
std::vector<std::uint32_t> readVertices(const NpzReader& npz, const char* array, std::size_t width,
                                        const NpzMeshes& meshes) {
  Shape shape;
  const std::vector<std::int64_t> values = npz.integers(array, shape);
  std::vector<std::uint32_t> vertices(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < 0 || static_cast<std::uint64_t>(values[i]) >= meshes.vertices)
      npz.fail(fmt::format(
          "{}[{}] has vertex {}, accepted: 0 to {}, a row of points", array,
          width == 1 ? fmt::format("{}", i) : fmt::format("{}, {}", i / width, i % width),
          values[i], meshes.vertices - 1));
    vertices[i] = static_cast<std::uint32_t>(values[i]);
  }
  return vertices;
}

void readFaces(const NpzReader& npz, NpzMeshes& meshes) {
  const Shape shape = npz.header("faces").shape;
  checkShape(npz, "faces", shape, {0, 3}, "(F, 3), triangles");
  if (shape[0] > kMaxMeshTriangles)
    npz.fail(
        fmt::format("faces has {} triangles, accepted: up to {}", shape[0], kMaxMeshTriangles));
  const std::vector<std::uint32_t> vertices = readVertices(npz, "faces", 3, meshes);
  meshes.triangles.resize(shape[0]);
  for (std::size_t t = 0; t < shape[0]; ++t)
    meshes.triangles[t] = {vertices[3 * t], vertices[3 * t + 1], vertices[3 * t + 2]};
}

// Sharpness of creases or corners, one per row of `of`.
std::vector<float> readSharpness(const NpzReader& npz, const std::string& array, const char* of,
                                 std::size_t count) {
  if (!npz.has(array)) npz.fail(fmt::format("has {} without {}", of, array));
  checkShape(npz, array.c_str(), npz.header(array).shape, {count},
             fmt::format("({},), one for each row of {}", count, of).c_str());
  Shape shape;
  const std::vector<double> values = npz.numbers(array, shape);
  std::vector<float> sharpness(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (!(values[i] >= 0))
      npz.fail(fmt::format("{}[{}] is {}, accepted: 0 (smooth) and up", array, i, values[i]));
    sharpness[i] = static_cast<float>(std::min<double>(values[i], kInfiniteSharpness));
  }
  return sharpness;
}

template <typename Tag>
void settled(const NpzReader& npz, const char* array, std::vector<Tag>& tags) {
  settleTags(
      tags, [](const Tag& tag) { return tag; },
      [&](const Tag&, const Tag&) {
        npz.fail(fmt::format("{} has the same row twice with different sharpness", array));
      });
  std::erase_if(tags, [](const Tag& tag) { return tag.sharpness == 0; });
}

void checkCreases(const NpzReader& npz, const NpzMeshes& meshes) {
  std::unordered_set<std::uint64_t> edges;
  edges.reserve(3 * meshes.triangles.size());
  for (const Triangle& t : meshes.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert(edgeKey(t[k], t[(k + 1) % 3]));
  for (const SharpEdge& crease : meshes.tags.edges)
    if (crease.v0 == crease.v1 || !edges.contains(edgeKey(crease.v0, crease.v1)))
      npz.fail(fmt::format("creases has the row ({}, {}), accepted: edges of a face", crease.v0,
                           crease.v1));
}

void readTags(const NpzReader& npz, NpzMeshes& meshes) {
  for (const auto& [sharpness, of] :
       {std::pair("corner_sharpness", "corners"), {"crease_sharpness", "creases"}})
    if (npz.has(sharpness) && !npz.has(of))
      npz.fail(fmt::format("has {} without {}", sharpness, of));
  if (npz.has("corners")) {
    checkShape(npz, "corners", npz.header("corners").shape, {0}, "(C,), vertices");
    const std::vector<std::uint32_t> corners = readVertices(npz, "corners", 1, meshes);
    const std::vector<float> sharpness =
        readSharpness(npz, "corner_sharpness", "corners", corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
      meshes.tags.vertices.push_back({corners[i], sharpness[i]});
    settled(npz, "corners", meshes.tags.vertices);
  }
  if (npz.has("creases")) {
    checkShape(npz, "creases", npz.header("creases").shape, {0, 2}, "(E, 2), edges");
    const std::vector<std::uint32_t> ends = readVertices(npz, "creases", 2, meshes);
    const std::vector<float> sharpness =
        readSharpness(npz, "crease_sharpness", "creases", ends.size() / 2);
    for (std::size_t i = 0; i < sharpness.size(); ++i)
      meshes.tags.edges.push_back({std::min(ends[2 * i], ends[2 * i + 1]),
                                   std::max(ends[2 * i], ends[2 * i + 1]), sharpness[i]});
    checkCreases(npz, meshes);
    settled(npz, "creases", meshes.tags.edges);
  }
}

template <typename T>
void add(const std::vector<T>& values, Sha256& digest) {
  digest.update(std::as_bytes(std::span(values)));
}

std::string sha256Of(const NpzMeshes& meshes) {
  Sha256 digest;
  add(meshes.points, digest);
  add(meshes.triangles, digest);
  add(meshes.tags.edges, digest);
  add(meshes.tags.vertices, digest);
  return digest.hex();
}

}  // namespace

TriangleMesh NpzMeshes::mesh(std::size_t keyframe) const {
  TriangleMesh made;
  made.positions.resize(vertices);
  const double* from = points.data() + 3 * vertices * keyframe;
  for (Vec3d& p : made.positions) {
    p = {from[0], from[1], from[2]};
    from += 3;
  }
  made.triangles = triangles;
  made.tags = tags;
  return made;
}

NpzMeshes readNpzMeshes(const std::filesystem::path& file) {
  const NpzReader npz(file);
  refuseOtherArrays(npz);
  NpzMeshes meshes;
  meshes.file = file;
  readPoints(npz, meshes);
  readFaces(npz, meshes);
  readTags(npz, meshes);
  meshes.sha256 = sha256Of(meshes);
  return meshes;
}

NpzFiles::NpzFiles(std::span<const Structure> structures) {
  for (const Structure& structure : structures)
    for (const Keyframe& keyframe : structure.keyframes)
      for (std::size_t i = 0; i < keyframe.files.size(); ++i)
        if (i >= keyframe.meshes.size() || !keyframe.meshes[i])
          if (const auto npz = npzKeyframeOf(keyframe.files[i])) files_[npz->file];
  std::vector<std::pair<const std::filesystem::path, File>*> all;
  for (auto& file : files_) all.push_back(&file);
  parallelBlocks(all.size(), 1, [&](std::size_t i, std::size_t) {
    try {
      all[i]->second.meshes = std::make_unique<const NpzMeshes>(readNpzMeshes(all[i]->first));
    } catch (const SceneError& error) {
      all[i]->second.refusal = error.what();
    }
  });
}

TriangleMesh NpzFiles::mesh(const std::filesystem::path& name, std::string& input) const {
  const auto npz = npzKeyframeOf(name);
  const auto found = npz ? files_.find(npz->file) : files_.end();
  if (found == files_.end()) throw SceneError(fmt::format("{}: is not read", name.string()));
  const auto& [meshes, refusal] = found->second;
  if (!meshes) throw SceneError(refusal);
  const std::size_t keyframe = npz->keyframe.value_or(0);
  if (keyframe >= meshes->keyframes || (!npz->keyframe && meshes->keyframes > 1))
    throw SceneError(fmt::format(
        "{}: the file has {} keyframe{}, accepted: {}[0]{}", name.string(), meshes->keyframes,
        meshes->keyframes == 1 ? "" : "s", npz->file.filename().string(),
        meshes->keyframes == 1
            ? ""
            : fmt::format(" to {}[{}]", npz->file.filename().string(), meshes->keyframes - 1)));
  input = fmt::format("{}[{}]", meshes->sha256, keyframe);
  return meshes->mesh(keyframe);
}

}  // namespace echocine
