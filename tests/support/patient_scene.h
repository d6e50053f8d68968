#pragma once
// A real patient's ventricles (published meshes, beside the project) as a scene, seen as one likes.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "core/hash.h"
#include "motion/mesh/mesh_io.h"
#include "support/paths.h"
#include "support/scene_text.h"

namespace echocine::support {

inline std::filesystem::path patientMeshes() {
  return std::filesystem::path(kSharedDir) / "real/meshes/bivme_patient1_25f";
}

inline std::vector<Vec3d> patientPoints(const std::string& name) {
  Sha256 digest;
  return readMesh(patientMeshes() / (name + "_000.obj"), digest).positions;
}

inline Vec3d centroid(const std::vector<Vec3d>& points) {
  Vec3d sum{};
  for (const Vec3d p : points) sum = sum + p;
  return (1.0 / static_cast<double>(points.size())) * sum;
}

inline std::string vectorText(Vec3d v) {
  return "[" + std::to_string(v.x) + ", " + std::to_string(v.y) + ", " + std::to_string(v.z) + "]";
}

// The left ventricle's long axis at end-diastole, mm.
struct PatientAxis {
  Vec3d apex, mitral, direction,
      to_left;  // units: from apex to mitral valve; towards the left side
};

inline PatientAxis longAxis() {
  const Vec3d mitral = centroid(patientPoints("mitral_valve")),
              tricuspid = centroid(patientPoints("tricuspid_valve"));
  const std::vector<Vec3d> left = patientPoints("lv_endo_closed");
  const Vec3d apex = *std::max_element(left.begin(), left.end(), [&](Vec3d a, Vec3d b) {
    return length(a - mitral) < length(b - mitral);
  });
  const Vec3d axis = normalised(mitral - apex), aside = mitral - tricuspid;
  return {apex, mitral, axis, normalised(aside - dot(aside, axis) * axis)};
}

// The probe 2 cm beyond the apex of the left ventricle, looking at the mitral valve, the left
// ventricle to the right.
inline void poseApical(SceneText& text) {
  const PatientAxis heart = longAxis();
  text.probe["apex"] = vectorText(heart.apex - 20.0 * heart.direction);
  text.probe["axis"] = vectorText(heart.direction);
  text.probe["lateral"] = vectorText(heart.to_left);
}

// A parasternal short axis: the probe 8 cm in front of the middle of the left ventricle, the plane
// across its long axis.
inline void poseShortAxis(SceneText& text) {
  const PatientAxis heart = longAxis();
  const Vec3d middle = 0.5 * (heart.apex + heart.mitral);
  const Vec3d depth = normalised(cross(heart.direction, heart.to_left));
  text.probe["apex"] = vectorText(middle - 80.0 * depth);
  text.probe["axis"] = vectorText(depth);
  text.probe["lateral"] = vectorText(heart.to_left);
}

// `folder`: of meshes with the patient's names, in mm.
inline SceneText patientScene(const std::filesystem::path& folder = patientMeshes()) {
  const auto files = [&](const std::string& name) {
    return "\"" + (folder / (name + "_*.obj")).string() + "\"";
  };
  SceneText text;
  poseApical(text);
  text.probe["sector_deg"] = "85";
  text.probe["depth_mm"] = "170";
  text.probe["lines"] = "128";
  text.probe["samples"] = "512";
  text.acquisition = {{"heart_rate_bpm", "72.2"}, {"frame_rate_hz", "30.0833"}};
  text.motion = {{"mesh_unit", "\"mm\""}};
  text.output["channels"] = "[\"Y\", \"medium.id\"]";
  text.addStructure("wall", "myocardium", files("epi"), 1,
                    "lids = [" + files("mitral_valve") + ", " + files("aortic_valve") + ", " +
                        files("tricuspid_valve") + ", " + files("pulmonary_valve") + "]");
  text.addStructure("lv", "blood", files("lv_endo_closed"), 2);
  text.addStructure("rv", "blood", files("rv_endo_closed"), 2);
  return text;
}

}  // namespace echocine::support
