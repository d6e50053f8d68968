#pragma once
// A heart of balls, in memory, and scenes that see it by a view.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "support/meshes.h"
#include "support/scene_text.h"

namespace echocine::support {

// A ball of 1 cm, stretched and put somewhere, mm.
inline TriangleMesh ellipsoid(Vec3d centre, Vec3d half) {
  const Mesh ball = icosphere(2, 1);
  TriangleMesh mesh;
  mesh.triangles = ball.triangles;
  for (const Vec3d p : ball.points)
    mesh.positions.push_back(centre + Vec3d{half.x * p.x, half.y * p.y, half.z * p.z});
  return mesh;
}

// A heart of balls in the axes of the parametric one, mm: z to the apex, x lateral, y anterior.
using Heart = std::map<std::string, std::vector<TriangleMesh>>;  // keyframes by name
inline const Heart& ballHeart() {
  static const Heart meshes = [] {
    Heart m;
    const auto add = [&](const char* name, Vec3d centre, Vec3d half) {
      m[name] = {ellipsoid(centre, half)};
    };
    add("lv", {0, 0, 45}, {25, 25, 45});
    add("rv", {-32, 13, 40}, {14, 25, 35});
    add("la", {0, -4, -18}, {20, 20, 20});
    add("ra", {-48, 0, -10}, {18, 18, 18});
    add("aorta", {-13, 18, 2}, {11, 11, 18});
    return m;
  }();
  return meshes;
}

inline NamedMeshes named(const Heart& heart) {
  NamedMeshes meshes;
  for (const auto& [name, keyframes] : heart)
    for (std::size_t k = 0; k < keyframes.size(); ++k)
      meshes[name + "_" + std::string(k < 10 ? "0" : "") + std::to_string(k)] =
          std::make_shared<const TriangleMesh>(keyframes[k]);
  return meshes;
}

inline SceneText viewScene(const std::vector<std::string>& structures) {
  SceneText text;
  text.probe = {{"view", "\"a4c\""}, {"lines", "16"}, {"samples", "64"}};
  text.motion = {{"mesh_unit", "\"mm\""}};
  for (const std::string& name : structures)
    text.structures += "[[structure]]\nname = \"" + name +
                       "\"\nmedium = \"blood\"\nkeyframes = \"" + name + "_*\"\n";
  return text;
}
inline const std::vector<std::string> kAll{"lv", "rv", "la", "ra", "aorta"};

inline Scene read(const SceneText& text, const Heart& heart = ballHeart()) {
  return parseScene(text.text(), "scene.toml", named(heart));
}
inline std::string refusal(const SceneText& text, const Heart& heart = ballHeart()) {
  try {
    placed(read(text, heart));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}
inline void expectRefused(const SceneText& text, const std::vector<std::string>& says,
                          const Heart& heart = ballHeart()) {
  const std::string message = refusal(text, heart);
  for (const std::string& part : says)
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

}  // namespace echocine::support
