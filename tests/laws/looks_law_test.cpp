// The looks of scanners on a planted heart: blood, muscle, black and white lie in the ranges of
// clinical pictures.

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/looks.h"
#include "scene/names.h"
#include "support/look_greys.h"

namespace echocine::looks_law {
namespace {

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
    const auto simulator = sharing(std::move(scene), simulatorOf(look, heart::View::plax));
    const LookGreys greys = greysOf(*simulator, false);
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
