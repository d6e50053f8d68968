// A scene's beat as models are cut from it.

#include <algorithm>

#include "core/parallel.h"
#include "fit/plane_tilt.h"
#include "motion/surfaces/probe_placement.h"

namespace echocine::fit {

namespace {

std::vector<SurfaceFrame> beatOf(const MeshMotion& motion, int frames) {
  std::vector<SurfaceFrame> surfaces(static_cast<std::size_t>(frames));
  parallelBlocks(surfaces.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      motion.frameAt(static_cast<double>(i) / frames, surfaces[i], false);
  });
  return surfaces;
}

// A parabola through the smallest volume and its neighbours; 0 without a left ventricle.
double smallestAt(const Scene& scene, const MeshMotion& motion,
                  const std::vector<SurfaceFrame>& frames) {
  const auto cavity = structureOf(scene, Role::lv_cavity);
  if (!cavity || frames.size() < 3) return 0;
  std::vector<double> volumes;
  for (const SurfaceFrame& frame : frames)
    volumes.push_back(motion.volumeIn(frame, motion.surfaces()[index(*cavity)]));
  const std::size_t n = volumes.size(),
                    least = static_cast<std::size_t>(
                        std::min_element(volumes.begin(), volumes.end()) - volumes.begin());
  const double before = volumes[(least + n - 1) % n], here = volumes[least],
               after = volumes[(least + 1) % n], bend = before - 2 * here + after;
  return (static_cast<double>(least) + (bend > 0 ? 0.5 * (before - after) / bend : 0)) /
         static_cast<double>(n);
}

double systoleOf(const Scene& scene, const MeshMotion& motion,
                 const std::vector<SurfaceFrame>& frames) {
  return scene.motion.end_systole_phase ? *scene.motion.end_systole_phase
                                        : smallestAt(scene, motion, frames);
}

}  // namespace

ModelLoop modelLoop(const Scene& scene, const MeshMotion& motion, int frames,
                    const std::optional<WallSegments>& segments, Focus focus) {
  const std::vector<SurfaceFrame> surfaces = beatOf(motion, frames);
  ModelLoop loop = ModelPlane(scene, motion.surfaces(), segments, focus).cut(surfaces);
  loop.systole = systoleOf(scene, motion, surfaces);
  return loop;
}

void tiltSurfaces(const PlaneTilt& tilt, std::vector<SurfaceFrame>& frames) {
  const Pose pose = turnedAndTilted({}, tilt.rotate_rad, tilt.tilt_rad);
  parallelBlocks(frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::vector<Vec3f>& surface : frames[i].positions_m)
        for (Vec3f& p : surface) p = toFloat(pose.fromWorld(toDouble(p)));
  });
}

TiltableModel::TiltableModel(const Scene& scene, const MeshMotion& motion, int frames,
                             std::optional<WallSegments> segments)
    : scene_(scene),
      surfaces_(motion.surfaces()),
      frames_(beatOf(motion, frames)),
      segments_(std::move(segments)),
      systole_(systoleOf(scene, motion, frames_)) {
  // It holds for the scene's own plane only.
  for (SurfaceTopology& surface : surfaces_) surface.near_plane.reset();
}

ModelLoop TiltableModel::at(const PlaneTilt& tilt) const {
  std::vector<SurfaceFrame> frames = frames_;
  tiltSurfaces(tilt, frames);
  ModelLoop loop = ModelPlane(scene_, surfaces_, segments_).cut(frames);
  loop.systole = systole_;
  return loop;
}

}  // namespace echocine::fit
