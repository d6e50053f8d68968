#pragma once
// Keyframes in NumPy files: points [K, V, 3], faces [F, 3], and optionally creases and corners.

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

// The content of a .npz file.
struct NpzMeshes {
  std::filesystem::path file;
  std::vector<double> points;  // K * V * 3
  std::size_t keyframes = 0, vertices = 0;
  std::vector<Triangle> triangles;
  MeshTags tags;
  std::string sha256;  // of all of the above

  // Precondition: keyframe < keyframes.
  TriangleMesh mesh(std::size_t keyframe) const;
};

// Reads a file. Throws SceneError that starts with its name: damaged, an array is missing, unknown
// or has another shape or type, a coordinate is not finite, a vertex does not exist.
NpzMeshes readNpzMeshes(const std::filesystem::path& file);

// All .npz files of a scene's structures, each read once, in parallel.
class NpzFiles {
 public:
  NpzFiles() = default;
  // Throws nothing for an unusable file: mesh() does.
  explicit NpzFiles(std::span<const Structure> structures);

  // The mesh of a keyframe's name (npz_keyframe.h); `input` becomes its contribution to the digest
  // of all input. Thread-safe. Throws like readNpzMeshes(), and if the keyframe does not exist.
  TriangleMesh mesh(const std::filesystem::path& name, std::string& input) const;

 private:
  struct File {
    std::unique_ptr<const NpzMeshes> meshes;
    std::string refusal;  // if there are no meshes
  };
  std::map<std::filesystem::path, File> files_;
};

}  // namespace echocine
