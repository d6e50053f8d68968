// Meshes: read, repaired, checked, subdivided, moved and traced, as a loop does it.

#include <cmath>

#include "motion/surfaces/mesh_motion.h"
#include "promises.h"
#include "scene/npz_keyframe.h"
#include "support/plain_scene.h"
#include "targets.h"

namespace echocine::fuzz {

namespace {

constexpr std::size_t kMostKeyframes = 8;  // more cost time and find nothing

// The file as the only keyframe of the only structure, 4 lines through it.
Scene sceneOf(std::vector<std::filesystem::path> files) {
  Scene scene = support::plainScene({support::medium("outside", 1000, 1500, 5, 1e-3),
                                     support::medium("inside", 1060, 1580, 10, 1e-2)});
  scene.probe.lines = 4;
  scene.probe.samples = 16;
  scene.motion.mesh_unit_m = 1e-2;
  scene.motion.interpolation_place = scene.motion.subdivision_place =
      scene.accuracy.normals_place = {"scene.toml", 1, "motion"};
  support::addStructure(scene, 1, 0);
  scene.structures[0].keyframes = {{std::move(files), 0}};
  scene.structures[0].place = {"scene.toml", 1, "structure.keyframes"};
  return scene;
}

void promisePhysical(const PolarFrame& frame) {
  for (const auto& [channel, plane] : frame.planes)
    for (const float value : plane)
      promise(std::isfinite(value) && value >= 0, "an intensity that is none");
}

void trace(const Scene& scene, const MeshMotion& motion) {
  SurfaceFrame surfaces;
  motion.frameAt(0.3, surfaces);
  for (const auto& positions : surfaces.positions_m)
    for (const Vec3f& p : positions)
      promise(std::isfinite(length(toDouble(p))), "a vertex nowhere");
  EffectPlan plan = planEffects(scene);
  PolarFrame frame;
  FrameGeometry geometry(motion.surfaces());
  geometry.update(surfaces);
  traceFrame(geometry, scene.probe, TraceSettings(scene, plan), planeRequest(scene, plan), frame);
  promisePhysical(frame);
  plan.refraction = false;
  PlaneSlice slice(motion.surfaces(), scene.probe);
  slice.update(surfaces);
  traceFrame(slice, scene.probe, TraceSettings(scene, plan, EchoCells::contours),
             planeRequest(scene, plan), frame);
  promisePhysical(frame);
}

void run(const Scene& scene) {
  accepts([&] { trace(scene, MeshMotion(scene)); });
}

// As it is; mended, subdivided and smooth; and as a membrane.
void everyWay(Scene scene) {
  run(scene);
  scene.structures[0].repair = {true, true, true, true};
  scene.motion.subdivision = 1;
  scene.accuracy.normals = Normals::smooth;
  run(scene);
  scene.structures[0].membrane = true;
  scene.structures[0].repair.fill_holes = false;
  scene.motion.subdivision = 0;
  run(scene);
}

void mesh(const char* name, std::string_view bytes) {
  everyWay(sceneOf({scratchFile(name, bytes)}));
}

}  // namespace

void obj(std::string_view bytes) {
  mesh("mesh.obj", bytes);
}
void ply(std::string_view bytes) {
  mesh("mesh.ply", bytes);
}
void off(std::string_view bytes) {
  mesh("mesh.off", bytes);
}
void stl(std::string_view bytes) {
  mesh("mesh.stl", bytes);
}

// Every keyframe of a NumPy file, as a loop.
void npz(std::string_view bytes) {
  const std::filesystem::path file = scratchFile("mesh.npz", bytes);
  std::vector<std::filesystem::path> names;
  if (!accepts([&] { names = npzKeyframeNames(file); }) || names.size() > kMostKeyframes) return;
  Scene scene = sceneOf({names.front()});
  for (std::size_t k = 1; k < names.size(); ++k)
    scene.structures[0].keyframes.push_back(
        {{names[k]}, static_cast<double>(k) / static_cast<double>(names.size())});
  everyWay(scene);
}

// Two files in one, parted by a line of dashes.
void lid(std::string_view bytes) {
  constexpr std::string_view kBetween = "\n---\n";
  const std::size_t end = std::min(bytes.find(kBetween), bytes.size());
  const std::string_view rest = bytes.substr(std::min(end + kBetween.size(), bytes.size()));
  everyWay(sceneOf({scratchFile("mesh.obj", bytes.substr(0, end)), scratchFile("lid.obj", rest)}));
}

}  // namespace echocine::fuzz
