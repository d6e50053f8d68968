#pragma once
// Leaflets with thickness, of a scene and of parametric hearts.

#include <map>
#include <string>

#include "motion/heart/heart_scene.h"
#include "motion/surfaces/leaflet_bodies.h"

namespace echocine::support {

// Bodies with the motion of their sheets.
struct Thick {
  explicit Thick(const Scene& scene) : motion(scene), bodies(scene, motion) {}
  SurfaceFrame at(double phase) const {
    SurfaceFrame frame;
    LeafletBodies::Sheets sheets;
    motion.frameAt(phase, frame, false);
    bodies.thicken(frame, sheets);
    return frame;
  }
  MeshMotion motion;
  LeafletBodies bodies;
};

// Apical four-chamber view, 8 keyframes. Without chordae.
inline Scene thickLeaflets(const std::map<std::string, double>& dials, double thickness_m,
                           double cusp_m = 0) {
  Scene scene = heart::heartScene(heart::parametersFrom(dials), heart::View::a4c, 8);
  scene.leaflets = {.thickness_m = thickness_m, .cusp_m = cusp_m};
  return scene;
}

}  // namespace echocine::support
