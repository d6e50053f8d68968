#pragma once
// Small meshes, keyframe files and scenes for the tests of the motion stage.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/hash.h"
#include "motion/mesh/mesh.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"

namespace echocine::motion_test {

inline constexpr Interpolation kInterpolations[] = {
    Interpolation::linear, Interpolation::catmull_rom, Interpolation::spline,
    Interpolation::fourier, Interpolation::cycle};

// A folder of its own for each test, gone when the test ends.
class TestFolder {
 public:
  TestFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("echocine_motion_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return path_ / name;
  }
  std::filesystem::path path(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// What a SceneError says; "no error" when nothing was thrown.
template <typename Action>
std::string errorOf(Action&& action) {
  try {
    action();
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no error";
}

// Six corners, eight faces looking outward; volume 4/3 r^3.
inline TriangleMesh octahedron(double r, Vec3d centre = {}) {
  TriangleMesh mesh;
  for (const Vec3d& p : {Vec3d{r, 0, 0}, Vec3d{-r, 0, 0}, Vec3d{0, r, 0}, Vec3d{0, -r, 0},
                         Vec3d{0, 0, r}, Vec3d{0, 0, -r}})
    mesh.positions.push_back(centre + p);
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

// The octahedron's triangles split in four `levels` times and drawn onto the sphere.
inline TriangleMesh sphere(double r, int levels) {
  TriangleMesh mesh = octahedron(r);
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto key = std::minmax(a, b);
      const auto [entry, is_new] =
          middles.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(r * normalised(mesh.positions[a] + mesh.positions[b]));
      return entry->second;
    };
    std::vector<Triangle> split;
    for (const Triangle& t : mesh.triangles) {
      const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      split.insert(split.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
    }
    mesh.triangles = std::move(split);
  }
  return mesh;
}

inline std::string objText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << std::setprecision(17);
  for (const Vec3d& p : mesh.positions) text << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const Triangle& t : mesh.triangles)
    text << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  return text.str();
}

inline Structure structureOf(const std::vector<std::filesystem::path>& files) {
  Structure structure;
  structure.name = "ball";
  structure.place = {"scene.toml", 7, "structure.keyframes"};
  for (std::size_t k = 0; k < files.size(); ++k)
    structure.keyframes.push_back(
        {{files[k]}, static_cast<double>(k) / static_cast<double>(files.size())});
  return structure;
}

// One structure, mesh unit centimetre, probe frame equal to the world's.
inline Scene sceneOf(const Structure& structure) {
  Scene scene;
  scene.motion.mesh_unit_m = 0.01;
  scene.motion.interpolation_place = {"scene.toml", 3, "motion.interpolation"};
  scene.motion.subdivision_place = {"scene.toml", 4, "motion.subdivision"};
  scene.structures.push_back(structure);
  return scene;
}

// A ball whose radius in cm at each keyframe is given, as files in the folder.
inline Scene beatingBall(const TestFolder& folder, const std::vector<double>& radii_cm,
                         int levels) {
  std::vector<std::filesystem::path> files;
  for (std::size_t k = 0; k < radii_cm.size(); ++k)
    files.push_back(
        folder.write("ball_" + std::to_string(k) + ".obj", objText(sphere(radii_cm[k], levels))));
  return sceneOf(structureOf(files));
}

// A cake: a fan of eight triangles about vertex 0, its top, whose rim is at z = 1.
inline TriangleMesh cake(Vec3d top) {
  TriangleMesh mesh;
  mesh.positions = {top, {0, 0, -1}};
  for (int ring = 0; ring < 2; ++ring)
    for (int i = 0; i < 8; ++i) {
      const double angle = 2 * std::numbers::pi * i / 8;
      mesh.positions.push_back({2 * std::cos(angle), 2 * std::sin(angle), ring == 0 ? 1.0 : -1.0});
    }
  for (std::uint32_t i = 0; i < 8; ++i) {
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % 8, c = 10 + i, d = 10 + (i + 1) % 8;
    mesh.triangles.insert(mesh.triangles.end(), {{0, a, b}, {a, c, b}, {b, c, d}, {1, d, c}});
  }
  return mesh;
}
inline constexpr Vec3d kMiddle{0, 0, 1};

// A structure with these keyframes, evenly spaced, as files ball_0.obj, ... in the folder.
inline Scene sceneWith(const TestFolder& folder, const std::vector<TriangleMesh>& keyframes,
                       Interpolation kind) {
  std::vector<std::filesystem::path> files;
  for (std::size_t k = 0; k < keyframes.size(); ++k)
    files.push_back(folder.write("ball_" + std::to_string(k) + ".obj", objText(keyframes[k])));
  Scene scene = sceneOf(structureOf(files));
  scene.motion.interpolation = kind;
  return scene;
}

// Number of open, and of wrongly run, edges: each edge must occur once in each direction.
inline std::size_t leakCount(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  std::size_t leaks = 0;
  for (const auto& [edge, sum] : balance) leaks += sum != 0;
  return leaks;
}

}  // namespace echocine::motion_test
