#include "motion/heart/heart_scene.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "motion/heart/heart_units.h"
#include "motion/heart/recording.h"
#include "scene/names.h"
#include "scene/role.h"

namespace echocine::heart {

namespace {

std::string vectorText(Vec3d v, double unit) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x / unit + 0.0, v.y / unit + 0.0,
                     v.z / unit + 0.0);
}

std::string listText(const std::vector<double>& values) {
  std::string text = "[";
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += i % 10 == 0 ? ",\n  " : ", ";
    text += fmt::format("{:.6f}", values[i]);
  }
  return text + "]";
}

const char* meaningOf(View view) {
  for (const ViewName& name : viewNames())
    if (name.view == view) return name.meaning;
  return "";
}

std::string structureText(const RecordedPart& part, const std::string& mesh_folder,
                          MeshFormat format) {
  std::string text = fmt::format("\n[[structure]]\nname = \"{}\"\nmedium = \"{}\"\n",
                                 part.kind.name, part.kind.medium);
  text +=
      part.kind.membrane ? "membrane = true\n" : fmt::format("priority = {}\n", part.kind.priority);
  if (const Role role = guessRole(part.kind.name); role != Role::none)
    text += fmt::format("role = \"{}\"\n", nameOf(role));
  if (part.kind.reflection_exponent != Structure{}.reflection_exponent)
    text += fmt::format("reflection_exponent = {:g}\n", part.kind.reflection_exponent);
  if (format == MeshFormat::npz)
    return text + fmt::format("keyframes = \"{}{}.npz\"\n", mesh_folder, part.kind.name);
  const bool still = part.control_m.size() == 1;
  return text + fmt::format("keyframes = \"{}{}{}.obj\"\n", mesh_folder, part.kind.name,
                            still ? "" : "_??");
}

// In millimetres, to a micrometre, like the files.
std::shared_ptr<const TriangleMesh> meshInMemory(const RecordedPart& part, std::size_t keyframe) {
  auto mesh = std::make_shared<TriangleMesh>();
  const auto millimetres = [](double metres) { return std::round(metres * 1e6) / 1e3 + 0.0; };
  for (const Vec3d p : part.control_m[keyframe])
    mesh->positions.push_back({millimetres(p.x), millimetres(p.y), millimetres(p.z)});
  mesh->triangles = part.faces;
  mesh->tags = part.tags;
  return mesh;
}

// The paper's picture has its own dynamic range; looks define theirs.
std::string signalText(Look look) {
  return fmt::format(
      "look = \"{}\"\n{}reference_intensity = 4e-4   # white, of the transmitted intensity: one "
      "gain "
      "for all hearts and views\n",
      nameOf(look), look == Look::paper ? "dynamic_range_db = 58\n" : "");
}

// A transoesophageal probe is near the heart: its frequency is higher, and no ribs are before it.
std::string artefactsText(View view) {
  return isTransoesophageal(view) ? "\n[artefacts]   # there is no chest wall before this probe\n"
                                    "acoustic_window = false\nshading = false\n"
                                  : "";
}

}  // namespace

std::string meshName(const RecordedPart& part, std::size_t keyframe) {
  return part.control_m.size() == 1 ? part.kind.name + ".obj"
                                    : fmt::format("{}_{:02d}.obj", part.kind.name, keyframe);
}

std::string sceneText(View view, const Parameters& parameters, const Recording& recording,
                      const std::string& mesh_folder, Look look, MeshFormat format) {
  const ProbePose& pose = recording.pose;
  const double hr_bpm = parameters.heart_rate_bpm;
  std::string text = fmt::format(
      R"(# A parametric heart, {}, {:g} beats per minute.
# World axes in mm: origin at the mitral ring at end-diastole, z to the apex of the left ventricle,
# x from the septum to its lateral wall, y to its anterior wall.

background = "soft_tissue"

[probe]
kind = "phased"
apex = {}
axis = {}
lateral = {}
sector_deg = {:g}
min_depth_mm = 2
depth_mm = {:g}
frequency_mhz = {:g}
lines = 256
samples = 1024

[acquisition]
heart_rate_bpm = {:g}
frame_rate_hz = 50
beats = 1

[motion]
mesh_unit = "mm"
subdivision = {}   # the meshes are control meshes of Loop surfaces
keyframe_heart_rate_bpm = {:g}   # another heart_rate_bpm above plays them with a diastole of other length
end_systole_phase = {:.6f}
keyframe_phases = {}
interpolation = "cycle"   # between keyframes the heart follows its own volume curve and stays within them

[signal]
{}{}
# Where structures overlap the highest priority wins. Cavities pierce walls; the septum belongs to the
# left ventricle and the right heart is wrapped round it.
)",
      meaningOf(view), hr_bpm, vectorText(pose.apex, kMillimetre), vectorText(pose.axis, 1),
      vectorText(pose.lateral, 1), pose.sector_deg, std::round(pose.depth_m * 1e4) * 0.1,
      isTransoesophageal(view) ? 5.0 : 2.5, hr_bpm, recording.levels, hr_bpm,
      recording.end_systole_phase, listText(recording.phases), signalText(look),
      artefactsText(view));
  for (const RecordedPart& part : recording.parts) text += structureText(part, mesh_folder, format);
  return text;
}

NamedMeshes meshesOf(const Recording& recording) {
  NamedMeshes meshes;
  for (const RecordedPart& part : recording.parts)
    for (std::size_t k = 0; k < part.control_m.size(); ++k)
      meshes.emplace(meshName(part, k), meshInMemory(part, k));
  return meshes;
}

Scene sceneOf(View view, const Parameters& parameters, const Recording& recording, Look look) {
  return parseScene(sceneText(view, parameters, recording, "", look), "heart", meshesOf(recording));
}

Recording heartRecording(const Parameters& parameters, View view, int keyframes) {
  if (const std::string fault = faultOf(parameters); !fault.empty())
    throw SceneError("heart: " + fault);
  return record(ParametricHeart(parameters), view, keyframes);
}

Scene heartScene(const Parameters& parameters, View view, int keyframes, Look look) {
  return sceneOf(view, parameters, heartRecording(parameters, view, keyframes), look);
}

}  // namespace echocine::heart
