#include <cmath>
#include <nlohmann/json.hpp>

#include "plan/effect_plan.h"
#include "promises.h"
#include "scene/scene_json.h"
#include "scene/scene_reader.h"
#include "targets.h"

namespace echocine::fuzz {

namespace {

bool isDirection(Vec3d d) {
  return std::abs(length(d) - 1) < 1e-9;
}

void promiseUsable(const Scene& scene) {
  const Pose& pose = scene.probe.pose;
  promise(isDirection(pose.x_axis) && isDirection(pose.y_axis) && isDirection(pose.z_axis),
          "the probe's axes are no directions");
  promise(std::isfinite(length(pose.origin)), "the probe is nowhere");
  for (const Medium& medium : scene.media)
    promise(std::isfinite(medium.impedance_kg_m2_s) && std::isfinite(medium.backscatter_per_m_sr),
            "medium " + medium.name + " has numbers beyond those of a computer");
  (void)planEffects(scene);
  (void)sceneJson(scene).dump();
  (void)mediaJson(scene).dump();
}

}  // namespace

// Files are named relative to a folder that is empty.
void scene(std::string_view bytes) {
  accepts([&] { promiseUsable(parseScene(bytes, scratchFolder() / "scene.toml")); });
}

}  // namespace echocine::fuzz
