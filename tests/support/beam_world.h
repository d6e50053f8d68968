#pragma once
// Beams of several rays, and sheets that they meet.

#include <numeric>

#include "plan/effect_plan.h"
#include "support/plain_scene.h"
#include "support/world.h"

namespace echocine::support {

inline EffectPlan beamPlan(const Scene& scene, int rays, bool lateral = true,
                           bool elevation = true) {
  Scene asked = scene;
  asked.accuracy.rays_per_beam = rays;
  asked.effects.elevation = elevation ? Switch::automatic : Switch::off;
  EffectPlan plan = planEffects(asked);
  plan.lateral_rays = lateral;
  plan.refraction = false;
  return plan;
}

// One line along z in water, samples of a tenth of a millimetre, and a thin sheet that sends the
// same back at every angle unless its exponent says otherwise.
inline World sheetWorld(const Mesh& mesh, double exponent = 0) {
  World world{plainScene({medium("water", 1000, 1540, 0, 1e-3), medium("sheet", 1100, 1540)}),
              {mesh}};
  addStructure(world.scene, 1, 0, true);
  world.scene.structures[0].reflection_exponent = exponent;
  world.scene.probe.samples = 1600;
  world.scene.probe.elevation_focus_m = 0.07;
  world.scene.output.channels = {Channel::reflection};
  world.scene.output.cine = false;
  return world;
}

inline double sumOf(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

inline double echoOf(const World& world, const EffectPlan& plan, int frame = 0) {
  return sumOf(traceWorld(world, plan, Tracer::embree, frame).planes.at(Channel::reflection));
}

// What one ray meets of a sheet across it.
inline double wholeEcho(const World& world) {
  World across = world;
  across.meshes = {sheet(1, 0.5, 0.08)};
  EffectPlan plan = planEffects(world.scene);
  plan.refraction = false;
  return echoOf(across, plan);
}

}  // namespace echocine::support
