#pragma once
// Random hearts as loops, for fits: dials that a fit searches and dials that it does not, planes
// off their views, and another scanner's media, gain, grey curve and, if requested, look.

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/hash_random.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/heart_fit.h"
#include "frame/simulator.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "support/view_loops.h"

namespace echocine::support {

inline constexpr View kPlantedViews[] = {View::a4c, View::a2c, View::plax};

struct PlantedHeart {
  std::map<std::string, double> dials;
  std::vector<echo::EchoLoop> loops;  // one for each of the first kPlantedViews
  bool beat_known = true;             // the first frame of each loop is end-diastole

  std::vector<fit::FitLoop> given() const {
    std::vector<fit::FitLoop> out;
    for (std::size_t v = 0; v < loops.size(); ++v) {
      out.push_back({kPlantedViews[v], loops[v], {}});
      if (beat_known) out.back().side.ed_frame = 0;
    }
    return out;
  }
};

// Volumes of the left ventricle, mL, over the beat from its start. The whole heart's meshes have
// numbers for names.
inline std::vector<double> volumesOf(const Scene& scene) {
  const MeshMotion motion(scene);
  std::optional<SurfaceId> cavity = structureOf(scene, Role::lv_cavity);
  for (std::size_t s = 0; s < scene.structures.size() && !cavity; ++s)
    if (scene.structures[s].name == "region_3") cavity = SurfaceId(s);
  constexpr int kSteps = 100;
  std::vector<double> ml;
  SurfaceFrame frame;
  for (int i = 0; i < kSteps; ++i) {
    motion.frameAt(static_cast<double>(i) / kSteps, frame, false);
    ml.push_back(millilitresFromCubicMetres(
        motion.volumeIn(frame, motion.surfaces()[index(cavity.value())])));
  }
  return ml;
}

// 2.3 beats of `frames` pictures each, as a scanner sends them without an ECG or a frame rate. They
// start at the part `start` of a beat.
inline echo::EchoLoop unknownBeats(Scene scene, int frames, double start, int seed) {
  constexpr double kBeats = 2.3;
  scene = ofOtherScanner(std::move(scene), seed);
  echo::EchoLoop loop = fit::renderedBeat(scene, 1, seed);
  loop.frames_per_beat = 0;
  loop.video.rate = {30, "container", false};
  const double beat_s = 1 / scene.acquisition.heart_rate_hz;
  scene.acquisition.frame_rate_hz = frames / beat_s;
  scene.acquisition.beats = 4;  // longer than the loop
  scene.output.width = loop.video.width, scene.output.height = loop.video.height;
  scene.output.ecg = scene.output.depth_ticks = false;
  scene.speckle.seed = scene.speckle.heterogeneity_seed = seed;
  scene.artefacts.noise_seed = scene.artefacts.clutter_seed = seed;
  const Simulator simulator(scene);
  loop.video.frames.resize(static_cast<std::size_t>(std::lround(kBeats * frames)));
  parallelBlocks(loop.video.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      loop.video.frames[i] =
          simulator.frame((start + static_cast<double>(i) / frames) * beat_s).image.pixels;
  });
  return loop;
}

// Heart `number` of an endless list in 1 to 3 views, with tilt and rotation of each plane within
// +-most_deg. sections: sections and walls of other shapes than the models'. beat_known: one beat
// from end-diastole, or else unknownBeats().
inline PlantedHeart plantedHeart(int number, std::size_t views, double most_deg,
                                 Look look = Look::scanner, bool sections = false,
                                 bool beat_known = true) {
  const auto drawn = [&](int k, double low, double high) {
    return low + (high - low) * uniformFromHash(hashOf(number, k, 911));
  };
  PlantedHeart out;
  out.dials = {{"ef", drawn(1, 0.25, 0.68)},
               {"edv", drawn(2, 85, 210)},
               {"wall-thickness", drawn(3, 7, 12)},
               {"sphericity", drawn(4, 0.53, 0.68)},
               {"hr", drawn(5, 60, 85)},
               {"la-volume", drawn(7, 40, 75)},
               {"twist", drawn(9, 6, 15)},
               {"conicity", drawn(10, 0.58, 0.84)},
               {"apical-motion", drawn(11, 0.8, 1.25)}};
  auto& dials = out.dials;
  if (sections)
    dials.insert({{"bow-lateral", drawn(12, -0.03, 0.03)},
                  {"bow-anterior", drawn(13, -0.03, 0.03)},
                  {"ellipticity", drawn(14, -0.17, 0.17)},
                  {"ellipticity-45", drawn(15, -0.17, 0.17)},
                  {"apical-thickness", drawn(16, 0.78, 1.28)},
                  {"lateral-thickness", drawn(17, 0.78, 1.28)},
                  {"anterior-thickness", drawn(18, 0.78, 1.28)}});
  dials["mapse"] = 13 * dials["ef"] / 0.6 * drawn(6, 0.8, 1.2);
  dials["rv-edv"] = dials["edv"] * std::max(drawn(8, 0.9, 1.2), 1.2 * dials["ef"]);
  for (std::size_t v = 0; v < views; ++v) {
    Scene scene = heart::heartScene(heart::parametersFrom(dials), kPlantedViews[v], 20, look);
    const int k = static_cast<int>(v);
    scene.probe.pose =
        turnedAndTilted(scene.probe.pose, radiansFromDegrees(drawn(30 + k, -most_deg, most_deg)),
                        radiansFromDegrees(drawn(20 + k, -most_deg, most_deg)));
    const int seed = 100 + 7 * number + k;
    out.loops.push_back(beat_known ? scannedLoop(scene, 20, seed)
                                   : unknownBeats(scene, 25, drawn(40 + k, 0, 1), seed));
  }
  out.beat_known = beat_known;
  return out;
}

// Meshes of another person, outside the models' family: `sceneIn` shows them in a view. EF and EDV
// are those of the meshes. `number` draws tilts, rotations, media and speckle.
inline PlantedHeart foreignHeart(Scene (*sceneIn)(View), int number, std::size_t views,
                                 double most_deg) {
  const auto drawn = [&](int k) {
    return most_deg * (2 * uniformFromHash(hashOf(number, k, 919)) - 1);
  };
  PlantedHeart out;
  for (std::size_t v = 0; v < views; ++v) {
    Scene scene = sceneIn(kPlantedViews[v]);
    if (v == 0) {
      const std::vector<double> ml = volumesOf(scene);
      out.dials["edv"] = ml.front();
      out.dials["ef"] = 1 - *std::min_element(ml.begin(), ml.end()) / ml.front();
    }
    const int k = static_cast<int>(v);
    scene.probe.pose = turnedAndTilted(scene.probe.pose, radiansFromDegrees(drawn(2 * k)),
                                       radiansFromDegrees(drawn(2 * k + 1)));
    out.loops.push_back(scannedLoop(std::move(scene), 25, 500 + 7 * number + k));
  }
  return out;
}

}  // namespace echocine::support
