#pragma once
// Grey levels of looks on a parametric heart, by structure.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/units.h"
#include "frame/scene_speckle.h"
#include "frame/simulator.h"
#include "motion/heart/heart_scene.h"
#include "scene/grey_curve.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"

namespace echocine::looks_law {

// Greys of 0 to 255 in beam space, by the role of their structure.
struct LookGreys {
  std::map<Role, std::vector<double>> by_role;
  std::map<Role, double> posterior;     // mean intensity over black in the deeper half of the lines
  std::vector<double> all, near, ring;  // near: in the first 15 mm; ring: at the mitral hinges
  std::vector<double> coat;             // mediastinum within about 5 mm of the sac
};

inline double quantileOf(std::vector<double> values, double q) {
  EXPECT_GT(values.size(), 100u);
  if (values.empty()) return -1;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

inline constexpr std::size_t kLines = 96, kSamples = 384;

inline Scene sceneOf(Look look, heart::View view, const std::map<std::string, double>& dials = {}) {
  Scene scene = heart::heartScene(heart::parametersFrom(dials), view, 6, look);
  scene.probe.lines = static_cast<int>(kLines);
  scene.probe.samples = static_cast<int>(kSamples);
  scene.output.channels = {Channel::structure};
  return scene;
}

// Shares the motion of another look. Precondition: the same heart.
inline std::unique_ptr<const Simulator> sharing(Scene scene, const Simulator& other) {
  return std::make_unique<const Simulator>(std::move(scene), other.sharedMotion(),
                                           other.sharedSpeckle()->field());
}

// The default heart in a look and view. The cases share simulators, and those of a view its motion.
inline const Simulator& simulatorOf(Look look, heart::View view) {
  static std::map<heart::View, std::map<Look, std::unique_ptr<const Simulator>>> made;
  auto& of_view = made[view];
  if (!of_view.contains(look)) {
    Scene scene = sceneOf(look, view);
    of_view.emplace(look, of_view.empty() ? std::make_unique<const Simulator>(std::move(scene))
                                          : sharing(std::move(scene), *of_view.begin()->second));
  }
  return *of_view.at(look);
}

// Grey levels and structures of the samples of a frame.
struct LabelledFrame {
  const Scene& scene;
  Frame frame;
  GreyCurve curve;

  LabelledFrame(const Simulator& simulator, double time_s)
      : scene(simulator.scene()), frame(simulator.frame(time_s)), curve(scene.signal) {}
  double greyAt(std::size_t i) const { return 255 * curve.at(static_cast<double>(frame.greys[i])); }
  const Structure* structureAt(std::size_t i) const {  // null in the background
    const std::uint32_t id = frame.truth->sample_ids[i];
    return id == 0 ? nullptr : &scene.structures[id - 1u];
  }
  Role roleAt(std::size_t i) const {
    const Structure* structure = structureAt(i);
    return structure ? roleOf(*structure) : Role::none;
  }
};

inline LookGreys greysOf(const Simulator& simulator, bool end_systole) {
  const Scene& scene = simulator.scene();
  const double time_s =
      scene.motion.end_systole_phase.value_or(0.35) / scene.acquisition.heart_rate_hz;
  const LabelledFrame labelled(simulator, end_systole ? time_s : 0);
  const Greys& all = labelled.frame.greys;
  const ScanGeometry geometry(scene.probe);
  LookGreys greys;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double grey = labelled.greyAt(i);
    greys.all.push_back(grey);
    if (geometry.sampleDepth(static_cast<int>(i % kSamples)) < 15e-3) greys.near.push_back(grey);
    if (labelled.structureAt(i)) greys.by_role[labelled.roleAt(i)].push_back(grey);
  }
  std::map<Role, std::pair<double, double>> sums;
  const auto isNear = [&](std::size_t i, Role role, std::size_t lines, std::size_t samples) {
    for (std::size_t line = i / kSamples - std::min(i / kSamples, lines);
         line <= std::min(i / kSamples + lines, all.size() / kSamples - 1); ++line)
      for (std::size_t k = i % kSamples - std::min(i % kSamples, samples);
           k <= std::min(i % kSamples + samples, kSamples - 1); ++k)
        if (labelled.roleAt(line * kSamples + k) == role) return true;
    return false;
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const Structure* structure = labelled.structureAt(i);
        structure && structure->name == "mediastinum" && isNear(i, Role::pericardium, 2, 12))
      greys.coat.push_back(labelled.greyAt(i));
  // The mitral ring is within about 6 mm of the atrium, and within 7 mm of both cavities.
  const auto isAtRing = [&](std::size_t i) { return isNear(i, Role::la, 3, 14); };
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const Role role = labelled.roleAt(i); role == Role::lv_wall || role == Role::la_wall)
      if (isNear(i, Role::la, 3, 18) && isNear(i, Role::lv_cavity, 3, 18))
        greys.ring.push_back(labelled.greyAt(i));
  for (std::size_t i = 0; i < all.size(); ++i)
    if (const Role role = labelled.roleAt(i); role != Role::none && i % kSamples > kSamples / 2 &&
                                              !(role == Role::lv_wall && isAtRing(i))) {
      auto& [sum, count] = sums[role];
      sum += intensityFromDecibels(scene.signal.dynamic_range_db * static_cast<double>(all[i]));
      ++count;
    }
  for (const auto& [role, s] : sums) greys.posterior[role] = s.first / s.second;
  return greys;
}

inline LookGreys greysOf(Look look, heart::View view = heart::View::a4c, bool end_systole = true) {
  return greysOf(simulatorOf(look, view), end_systole);
}

}  // namespace echocine::looks_law
