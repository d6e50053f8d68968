#pragma once
// Hearts of three families in eight views, and loops of them as a scanner with a look of its own
// shows them.

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/hash_random.h"
#include "echo/echo_loop.h"
#include "fit/own_loop.h"
#include "motion/heart/heart_scene.h"
#include "motion/views/heart_marks.h"
#include "support/patient_scene.h"
#include "support/real_hearts.h"
#include "support/scene_text.h"

namespace echocine::support {

// Hearts whose scenes stand for what is seen: "shipped" with given dials, "patient", "whole".
enum class Family { shipped, patient, whole };
inline constexpr Family kFamilies[] = {Family::shipped, Family::patient, Family::whole};
inline const char* nameOf(Family family) {
  return family == Family::shipped   ? "parametric"
         : family == Family::patient ? "patient"
                                     : "whole heart";
}

inline void holdProbe(View view, const std::vector<RoleSurface>& surfaces, double metres_per_unit,
                      SceneText& text) {
  const HeartMarks heart = findHeart(surfaces, {});
  const ProbePose pose =
      standardPose(view, heart.frame, heart.outside_m, heart.wall_m, heart.front_m);
  text.probe["apex"] = vectorText(1 / metres_per_unit * pose.apex);
  text.probe["axis"] = vectorText(pose.axis);
  text.probe["lateral"] = vectorText(pose.lateral);
  text.probe["sector_deg"] = std::to_string(pose.sector_deg);
  text.probe["depth_mm"] = std::to_string(1e3 * pose.depth_m);
  text.probe["lines"] = "128";
  text.probe["samples"] = "512";
  text.signal["look"] = "\"scanner\"";
}

// Segmented chambers that shorten by 12 % along the long axis and by 18 % across it, about the
// apex, as a raised cosine: an ejection fraction of 0.41.
inline Scene wholeHeartScene(View view) {
  static const RealHeart heart = wholeHeart();
  static const NamedMeshes meshes = [] {
    constexpr int kKeyframes = 10;
    NamedMeshes named;
    const Vec3d axis = normalised(heart.mitral - heart.apex);
    for (std::size_t s = 0; s < heart.surfaces.size(); ++s)
      for (int k = 0; k < kKeyframes; ++k) {
        const double part = 0.5 * (1 - std::cos(2 * std::numbers::pi * k / kKeyframes));
        TriangleMesh mesh;
        mesh.triangles = heart.triangles[s];
        for (const Vec3d p : heart.surfaces[s].points_m) {
          const Vec3d from = p - heart.apex, along = dot(from, axis) * axis;
          mesh.positions.push_back(heart.apex + (1 - 0.12 * part) * along +
                                   (1 - 0.18 * part) * (from - along));
        }
        named[heart.surfaces[s].name + "_0" + std::to_string(k) + ".obj"] =
            std::make_shared<const TriangleMesh>(std::move(mesh));
      }
    return named;
  }();
  SceneText text;
  text.motion = {{"mesh_unit", "\"m\""}};
  holdProbe(view, heart.surfaces, 1, text);
  for (const RoleSurface& s : heart.surfaces)
    text.addStructure(s.name, s.role == Role::lv_wall ? "myocardium" : "blood",
                      "\"" + s.name + "_*.obj\"", s.role == Role::lv_wall ? 1 : 2);
  return parseScene(text.text(), "scene.toml", meshes);
}

inline Scene sceneOf(Family family, View view) {
  if (family == Family::shipped)
    return heart::heartScene(
        heart::parametersFrom({{"ef", 0.45}, {"edv", 150}, {"wall-thickness", 11}, {"hr", 72}}),
        view, 20, Look::scanner);
  if (family == Family::whole) return wholeHeartScene(view);
  static const RealHeart heart = patientHeart();
  SceneText text = patientScene();
  holdProbe(view, heart.surfaces, 1e-3, text);
  text.output.clear();
  return parseScene(text.text(), "scene.toml");
}

// The scene as another scanner shows it: media, gain and grey curve are its own, drawn from `seed`.
inline Scene ofOtherScanner(Scene scene, int seed) {
  int number = 0;
  const auto drawn = [&](double low, double high) {
    return low + (high - low) * uniformFromHash(hashOf(static_cast<std::uint64_t>(seed), 7,
                                                       static_cast<std::uint64_t>(number++)));
  };
  for (Medium& medium : scene.media) {
    medium.backscatter_per_m_sr *= std::pow(10, drawn(-0.2, 0.2));
    medium.attenuation_np_per_m *= drawn(0.85, 1.15);
  }
  scene.signal.gain_db += drawn(-6, 6);
  scene.signal.grey_gamma *= drawn(0.8, 1.25);
  scene.signal.dynamic_range_db += drawn(-8, 8);
  return scene;
}

// One beat as another scanner shows it, with speckle of its own. The first frame is end-diastole.
inline echo::EchoLoop scannedLoop(Scene scene, int frames, int seed) {
  return fit::renderedBeat(ofOtherScanner(std::move(scene), seed), frames, seed);
}

}  // namespace echocine::support
