// The looks of scanners on a planted heart: blood, muscle, black and white lie in the ranges of
// clinical pictures.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "core/units.h"
#include "frame/simulator.h"
#include "motion/heart/heart_scene.h"
#include "scene/grey_curve.h"
#include "scene/looks.h"
#include "scene/names.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"

namespace echocine::looks_law {
namespace {

// Greys of 0 to 255 in beam space, by the role of their structure.
struct LookGreys {
  std::map<Role, std::vector<double>> by_role;
  std::map<Role, double> posterior;     // mean intensity over black in the deeper half of the lines
  std::vector<double> all, near, ring;  // near: in the first 15 mm; ring: at the mitral hinges
  std::vector<double> coat;             // mediastinum within about 5 mm of the sac
};

double quantileOf(std::vector<double> values, double q) {
  EXPECT_GT(values.size(), 100u);
  if (values.empty()) return -1;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

constexpr std::size_t kLines = 96, kSamples = 384;

Scene sceneOf(Look look, heart::View view, const std::map<std::string, double>& dials = {}) {
  Scene scene = heart::heartScene(heart::parametersFrom(dials), view, 6, look);
  scene.probe.lines = static_cast<int>(kLines);
  scene.probe.samples = static_cast<int>(kSamples);
  scene.output.channels = {Channel::structure};
  return scene;
}

// The default heart in a look and view. The cases share simulators.
const Simulator& simulatorOf(Look look, heart::View view) {
  static std::map<std::pair<Look, heart::View>, std::unique_ptr<const Simulator>> made;
  auto& simulator = made[{look, view}];
  if (!simulator) simulator = std::make_unique<const Simulator>(sceneOf(look, view));
  return *simulator;
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

LookGreys greysOf(const Simulator& simulator, bool end_systole) {
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

LookGreys greysOf(Look look, heart::View view = heart::View::a4c, bool end_systole = true) {
  return greysOf(simulatorOf(look, view), end_systole);
}

// Greys of a look relative to clinical stills: the loop that "faint" imitates has little gain. Its
// 95 % quantile is 78 to 87, their median 161 to 207.
double brightnessOf(Look look) {
  return look == Look::faint ? 0.5 : 1;
}

// Samples near the probe outnumber their pixels, so shares are those of beam space. Black, white:
// stills of one scanner and "smooth" have no grey under 10; loops of others have 5 to 51 % there.
TEST(LooksLaw, ScannersShowBloodDarkAndMuscleGrey) {
  for (const Look look : scannerLooks()) {
    const std::string name(nameOf(look));
    const LookGreys greys = greysOf(look);
    const double lv = quantileOf(greys.by_role.at(Role::lv_cavity), 0.5),
                 la = quantileOf(greys.by_role.at(Role::la), 0.5),
                 ra = quantileOf(greys.by_role.at(Role::ra), 0.5),
                 wall = quantileOf(greys.by_role.at(Role::lv_wall), 0.5),
                 white = quantileOf(greys.all, 0.999);
    const double black = static_cast<double>(std::count_if(greys.all.begin(), greys.all.end(),
                                                           [](double grey) { return grey < 10; })) /
                         static_cast<double>(greys.all.size());
    std::printf("  %-8s LV %.0f LA %.0f RA %.0f wall %.0f p99.9 %.0f black %.3f\n", name.c_str(),
                lv, la, ra, wall, white, black);
    const double full = brightnessOf(look);
    EXPECT_GT(wall, 65 * full) << name;
    EXPECT_LT(wall, 130 * full) << name;
    // Clinical stills at end-systole: 30 or more in 90 % of them (288 patients of CAMUS).
    EXPECT_GT(wall - lv, 30 * full) << name;
    // 18 grey levels lie between atrium and ventricle if the gain is that of soft tissue.
    EXPECT_LT(la - lv, 16) << name;
    EXPECT_LT(ra - lv, 12) << name;
    EXPECT_GT(white, 165 * full) << name;
    if (look == Look::smooth) {
      EXPECT_LT(black, 0.01) << name;
    } else {
      EXPECT_GT(black, 0.05) << name;
      EXPECT_LT(black, 0.51) << name;
    }
  }
}

// Median grey of the first 15 mm in clinical four-chamber stills: quartiles 83 to 122 at
// end-diastole (288 patients of CAMUS). Without their gain of the near field, "scanner" and
// "portable" are above them.
TEST(LooksLaw, TheNearFieldIsAsBrightAsInClinicalStills) {
  for (const Look look : {Look::scanner, Look::smooth, Look::portable}) {
    const double near = quantileOf(greysOf(look, heart::View::a4c, false).near, 0.5);
    std::printf("  %-8s near field %.0f\n", std::string(nameOf(look)).c_str(), near);
    EXPECT_GT(near, 83) << nameOf(look);
    EXPECT_LT(near, 122) << nameOf(look);
  }
}

// Echoes of surfaces that face the probe saturate: 222 to 254 in stills of a scanner, 254 in its
// brightest. They are few: the 95 % quantile stays within that of clinical stills (145 to 230).
TEST(LooksLaw, ThePericardiumThatFacesTheProbeIsWhite) {
  for (const Look look : {Look::scanner, Look::portable}) {
    const LookGreys greys = greysOf(look, heart::View::plax, false);
    const double white = quantileOf(greys.all, 0.999), bright = quantileOf(greys.all, 0.95);
    std::printf("  %-8s p95 %.0f p99.9 %.0f\n", std::string(nameOf(look)).c_str(), bright, white);
    EXPECT_GE(white, 245) << nameOf(look);
    EXPECT_LT(bright, 230) << nameOf(look);
  }
}

// Cavities are dark regions in grey tissue. Where the tissue beside the sac is as dark as blood,
// walls and sac are closed bright rings, as in a drawing.
TEST(LooksLaw, TheHeartLiesInGreyTissue) {
  for (const Look look : scannerLooks()) {
    const std::string name(nameOf(look));
    for (const heart::View view : {heart::View::a4c, heart::View::plax, heart::View::psax_mid}) {
      const LookGreys greys = greysOf(look, view, false);
      const double coat = quantileOf(greys.coat, 0.5),
                   blood = quantileOf(greys.by_role.at(Role::lv_cavity), 0.5),
                   wall = quantileOf(greys.by_role.at(Role::lv_wall), 0.5);
      std::printf("  %-8s blood %.0f, beside the sac %.0f, wall %.0f\n", name.c_str(), blood, coat,
                  wall);
      EXPECT_GT(coat, blood + 45 * brightnessOf(look)) << name;
      EXPECT_LT(coat, wall + 45) << name;
    }
  }
}

// In 20 healthy people at 2.25 MHz, the integrated backscatter of the posterior wall is 17 +- 3 %
// of the pericardium's. The looks made after clinical stills are in this range, the others below
// it. Without heterogeneity, whose mean is 1.
TEST(LooksLaw, PericardiumExceedsThePosteriorWallAsInHealthyPeople) {
  for (const Look look :
       {Look::scanner, Look::smooth, Look::contrast, Look::sharp, Look::portable}) {
    Scene scene = sceneOf(look, heart::View::plax);
    scene.speckle.heterogeneity_db = 0;
    const LookGreys greys = greysOf(Simulator(std::move(scene)), false);
    const double share = greys.posterior.at(Role::lv_wall) / greys.posterior.at(Role::pericardium);
    std::printf("  %-8s wall / pericardium %.3f\n", std::string(nameOf(look)).c_str(), share);
    EXPECT_LT(share, 0.21) << nameOf(look);
    const bool clinical = look == Look::scanner || look == Look::smooth;
    EXPECT_GT(share, clinical ? 0.13 : 0.05) << nameOf(look);
  }
}

// Fibrous rings stand out in apical views: the brightest tenth at the mitral hinges is brighter
// than that of muscle.
TEST(LooksLaw, TheMitralRingStandsOutInApicalViews) {
  for (const bool end_systole : {false, true})
    for (const heart::View view : {heart::View::a4c, heart::View::a2c}) {
      const LookGreys greys = greysOf(Look::scanner, view, end_systole);
      const double ring = quantileOf(greys.ring, 0.9),
                   wall = quantileOf(greys.by_role.at(Role::lv_wall), 0.9),
                   pericardium = quantileOf(greys.by_role.at(Role::pericardium), 0.9);
      std::printf("  %s %s: ring %.0f, wall %.0f, pericardium %.0f, p99.9 %.0f\n",
                  view == heart::View::a4c ? "a4c" : "a2c", end_systole ? "ES" : "ED", ring, wall,
                  pericardium, quantileOf(greys.all, 0.999));
      EXPECT_GT(ring, wall + 25);
    }
}

// Septum less lateral wall, medians of their grey levels, at half the height of the cavity.
// Clinical four-chamber stills at end-diastole: quartiles 13 and 53 (288 patients of CAMUS). The
// mean over chest walls is within them for the looks made after these stills.
TEST(LooksLaw, TheLateralWallOfAnApicalViewIsNotMuchDarkerThanTheSeptum) {
  constexpr int kChestWalls = 4;
  for (const Look look : {Look::scanner, Look::smooth}) {
    double sum = 0;
    for (int seed = 1; seed <= kChestWalls; ++seed) {
      const Simulator& source = simulatorOf(look, heart::View::a4c);
      Scene scene = source.scene();
      scene.artefacts.shading_seed = seed;
      const Simulator simulator(std::move(scene), source);
      const LabelledFrame labelled(simulator, 0);
      std::vector<double> depths;
      for (std::size_t i = 0; i < kLines * kSamples; ++i)
        if (labelled.roleAt(i) == Role::lv_cavity)
          depths.push_back(static_cast<double>(i % kSamples));
      const double top = quantileOf(depths, 0.01), bottom = quantileOf(depths, 0.99);
      std::vector<double> septum, lateral;
      for (auto k = static_cast<std::size_t>(top + 0.3 * (bottom - top));
           static_cast<double>(k) < top + 0.7 * (bottom - top); ++k) {
        bool seen = false;  // the cavity: the septum is before it
        for (std::size_t at = k; at < kLines * kSamples; at += kSamples) {
          const Role role = labelled.roleAt(at);
          seen = seen || role == Role::lv_cavity;
          if (role != Role::lv_wall) continue;
          (seen ? lateral : septum).push_back(labelled.greyAt(at));
        }
      }
      sum += quantileOf(septum, 0.5) - quantileOf(lateral, 0.5);
    }
    const double darker = sum / kChestWalls;
    std::printf("  %-8s septum less lateral wall %.0f\n", std::string(nameOf(look)).c_str(),
                darker);
    EXPECT_GT(darker, 13) << nameOf(look);
    EXPECT_LT(darker, 53) << nameOf(look);
  }
}

TEST(LooksLaw, PortablePericardiumIsWhiterThanThePosteriorWall) {
  for (const double edv_ml : {90.0, 130.0, 170.0}) {
    Scene scene = sceneOf(Look::portable, heart::View::plax, {{"edv", edv_ml}});
    scene.speckle.seed = scene.artefacts.shading_seed = static_cast<int>(edv_ml);
    const Simulator simulator(std::move(scene));
    for (const double time_s : {0.0, 0.33, 0.7}) {
      const LabelledFrame labelled(simulator, time_s);
      std::map<Role, std::vector<double>> greys;  // in the middle half of the sector, behind
      for (std::size_t line = kLines / 4; line < 3 * kLines / 4; ++line)
        for (std::size_t i = line * kSamples + kSamples / 2; i < (line + 1) * kSamples; ++i)
          if (labelled.structureAt(i)) greys[labelled.roleAt(i)].push_back(labelled.greyAt(i));
      const double wall = quantileOf(greys[Role::lv_wall], 0.5),
                   pericardium = quantileOf(greys[Role::pericardium], 0.5);
      std::printf("  EDV %.0f, %.2f s: wall %.0f, pericardium %.0f\n", edv_ml, time_s, wall,
                  pericardium);
      EXPECT_GT(pericardium, wall + 15) << edv_ml << " mL, " << time_s << " s";
    }
  }
}

}  // namespace
}  // namespace echocine::looks_law
