#pragma once
// A scene with its meshes in memory, traced through either geometry.

#include <gtest/gtest.h>

#include <optional>

#include "core/parallel.h"
#include "plan/effect_plan.h"
#include "support/meshes.h"
#include "trace/thick_slice.h"
#include "trace/trace_beams.h"

namespace echocine::support {

// Mesh i is that of scene.structures[i], in metres in the probe frame.
struct World {
  Scene scene;
  std::vector<Mesh> meshes;
  std::vector<std::vector<Vec3f>> normals{};  // per vertex, or none

  std::vector<SurfaceTopology> topology() const {
    std::vector<SurfaceTopology> all;
    for (std::size_t s = 0; s < meshes.size(); ++s)
      all.push_back({SurfaceId(static_cast<std::uint32_t>(s)), meshes[s].triangles,
                     static_cast<std::uint32_t>(meshes[s].points.size()),
                     scene.structures[s].membrane});
    return all;
  }
  SurfaceFrame frame() const {
    SurfaceFrame frame;
    for (const Mesh& mesh : meshes) {
      frame.positions_m.emplace_back();
      for (const Vec3d& p : mesh.points) frame.positions_m.back().push_back(toFloat(p));
    }
    frame.normals = normals;
    return frame;
  }
};

enum class Tracer { slice, cells, embree };
inline constexpr Tracer kTracers[] = {Tracer::slice, Tracer::cells, Tracer::embree};

inline const char* nameOf(Tracer tracer) {
  return tracer == Tracer::slice ? "slice" : tracer == Tracer::cells ? "cells" : "embree";
}

// Every channel that the scene asks for; refraction only where the plan has it and the tracer can.
// The hierarchy traces as many rays per beam as the plan has, drawn for a frame's number.
inline PolarFrame traceWorld(const World& world, EffectPlan plan, Tracer tracer,
                             int frame_index = 0) {
  const std::vector<SurfaceTopology> topology = world.topology();
  const SurfaceFrame frame = world.frame();
  if (tracer != Tracer::embree) plan.refraction = false;
  const TraceSettings settings(world.scene, plan,
                               tracer == Tracer::cells ? EchoCells::contours : EchoCells::none);
  const PlaneRequest request = planeRequest(world.scene, plan);
  PolarFrame polar;
  if (tracer == Tracer::embree) {
    FrameGeometry geometry(topology);
    geometry.update(frame);
    if (plan.rays_per_beam > 1) {
      const BeamRays beams(world.scene.probe, beamSpread(plan, world.scene.acquisition.seed));
      traceBeams(geometry, world.scene.probe, settings, request, beams, frame_index,
                 {0, world.scene.probe.lines}, polar);
      return polar;
    }
    traceFrame(geometry, world.scene.probe, settings, request, polar);
  } else {
    PlaneSlice slice(topology, world.scene.probe);
    slice.update(frame);
    traceFrame(slice, world.scene.probe, settings, request, polar);
  }
  return polar;
}

inline PolarFrame traceWorld(const World& world, Tracer tracer) {
  return traceWorld(world, planEffects(world.scene), tracer);
}

// Every channel, over the slices across the plane that the plan has.
inline PolarFrame traceThickWorld(const World& world, const EffectPlan& plan, EchoCells cells) {
  const std::vector<SurfaceTopology> topology = world.topology();
  SurfaceFrame frame = world.frame();
  Scene scene = world.scene;
  scene.accuracy.elevation_slices = plan.elevation_slices;
  PlaneSlice plane(topology, scene.probe);
  SideSlices sides(topology, scene);
  plane.update(frame);
  sides.update(frame);
  EXPECT_TRUE(frame.positions_m == world.frame().positions_m) << "surfaces were left bent";
  PolarFrame polar, side;
  traceThick(plane, sides, scene.probe, TraceSettings(scene, plan, cells),
             planeRequest(scene, plan), polar, side);
  return polar;
}

}  // namespace echocine::support
