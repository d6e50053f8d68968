// Parts of a fit of dials: designs of hearts, shares of hearts, and strain.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/error.h"
#include "core/hash_random.h"
#include "fit/fit_cost.h"
#include "fit/fit_strain.h"
#include "fit/heart_design.h"
#include "fit/heart_prior.h"
#include "fit/searched_dials.h"
#include "motion/heart/heart_cycle.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/left_ventricle.h"
#include "motion/surfaces/interior_motion.h"
#include "truth/frame_truth.h"

namespace echocine::fit {
namespace {

std::vector<double> drawnWithin(const std::vector<DialRange>& ranges, int n) {
  std::vector<double> out;
  for (const DialRange& range : ranges)
    out.push_back(range.low + (range.high - range.low) *
                                  uniformFromHash(hashOf(n, static_cast<int>(out.size()), 5)));
  return out;
}

std::vector<DialRange> searchedRanges() {
  std::vector<DialRange> out;
  for (const SearchedDial& dial : searchedDials()) out.push_back(dial.range);
  return out;
}

// The prior has each searched dial, and a step is a part of its range also in a narrow one.
TEST(FitDesign, SearchedDialsHaveAPriorAndAStep) {
  ASSERT_EQ(searchedDials().size(), kPriorDials.size() + std::size(kLonePriors));
  for (std::size_t i = 0; i < searchedDials().size(); ++i) {
    const SearchedDial& dial = searchedDials()[i];
    const bool joint = i < kPriorDials.size();
    EXPECT_EQ(dial.range.key, joint ? kPriorDials[i] : kLonePriors[i - kPriorDials.size()].key);
    EXPECT_EQ(stepOf(dial.range), dial.step);
    EXPECT_EQ(stepOf({dial.range.key, 0, dial.step}), dial.step / 4);
  }
  EXPECT_NEAR(stepOf({"hr", 60, 80}), 2, 1e-12);
}

// Fewer views determine fewer dials. Without own look, sections keep the shape of the models.
TEST(FitDesign, DefaultDialsAreSearchedDials) {
  std::set<std::string> known;
  for (const SearchedDial& dial : searchedDials()) known.insert(dial.range.key);
  for (const bool own_look : {false, true})
    for (const std::size_t views : {1u, 2u, 3u}) {
      const std::vector<std::string> keys = dialsSearchedIn(views, own_look);
      EXPECT_EQ(keys.size(), views == 1 ? 5u : views == 2 ? 6u : own_look ? 15u : 8u);
      EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), keys.size());
      for (const std::string& key : keys) EXPECT_TRUE(known.contains(key)) << key;
    }
}

TEST(FitDesign, OnlySearchedDialsCanBeSearched) {
  checkSearched({"ef", "sphericity"});
  EXPECT_THROW(checkSearched({"ef", "wall_thickness"}), SceneError);
  EXPECT_TRUE(isFixed("sphericity", {{"lv-length", 90}}));
  EXPECT_TRUE(isFixed(kRightRatio, {{"rv-edv", 150}}));
  EXPECT_FALSE(isFixed("sphericity", {{"edv", 150}}));
}

// The prior of a heart whose length is given is that of its shape.
TEST(FitDesign, TheLengthGivesTheSphericityOfThePrior) {
  const std::map<std::string, double> round{{"edv", 140}, {"sphericity", 0.55}, {"conicity", 0.8}};
  const double length_mm = 1e3 * heart::LeftVentricle(heart::parametersFrom(round)).length();
  const PriorDials by_length =
      priorDialsOf({{"edv", 140}, {"conicity", 0.8}, {"lv-length", length_mm}});
  for (std::size_t i = 0; i < by_length.size(); ++i)
    EXPECT_NEAR(by_length[i], priorDialsOf(round)[i], 1e-9) << kPriorDials[i];
}

// The right atrium follows the left one, unless it is given.
TEST(FitDesign, TheRightAtriumFollowsTheLeft) {
  std::map<std::string, double> none{{"ef", 0.5}}, healthy{{"la-volume", 55}},
      large{{"la-volume", 110}}, given{{"la-volume", 110}, {"ra-volume", 40}};
  for (auto* dials : {&none, &healthy, &large, &given}) addFollowers(*dials);
  EXPECT_FALSE(none.contains("ra-volume"));
  EXPECT_EQ(healthy.at("ra-volume"), heart::Parameters{}.ra_volume_ml);
  EXPECT_NEAR(large.at("ra-volume"), 2 * healthy.at("ra-volume"), 1e-12);
  EXPECT_EQ(given.at("ra-volume"), 40);
}

// The right ventricle's volume follows a searched ratio, and can always eject the stroke volume.
TEST(FitDesign, TheRightVentricleFollowsItsRatio) {
  for (const double ef : {0.15, 0.5, 0.68, 0.75})
    for (const double edv : {50.0, 120.0, 280.0})
      for (const double ratio : {0.8, 1.0, 1.35}) {
        std::map<std::string, double> dials{{"ef", ef}, {"edv", edv}, {kRightRatio, ratio}};
        addFollowers(dials);
        EXPECT_FALSE(dials.contains(kRightRatio));
        EXPECT_NEAR(dials.at("rv-edv"), std::max(ratio * edv, ef * edv / heart::kMostRightEjected),
                    1e-3);
        EXPECT_EQ(heart::faultOf(heart::parametersFrom(dials)), "");
      }
  // Without edv, the ratio is relative to the default left ventricle.
  std::map<std::string, double> alone{{kRightRatio, 1.2}};
  addFollowers(alone);
  EXPECT_NEAR(alone.at("rv-edv"), 1.2 * heart::Parameters{}.edv_ml, 1e-9);
  EXPECT_NEAR(dialOf("dials", kRightRatio).get(heart::parametersFrom(alone)).value(), 1.2, 1e-12);
}

// A cubic in the first two dials and a quadratic in all is reproduced everywhere, also after places
// have moved.
TEST(FitDesign, PolynomialsAreReproduced) {
  const auto f = [](const std::vector<double>& v) {
    const double e = v[0], d = v[1] / 100;
    return 3 + 2 * e - e * e * e + e * d * d - 0.3 * d * d * d + 0.1 * v[2] * v[3] + v[4] * e -
           0.02 * v[4] * v[4] + 1e-4 * v[5] * v[5] - 1e-3 * v[5] * v[2] + v[9] * e - v[12] * d +
           2 * v[15];
  };
  const std::vector<DialRange> ranges = searchedRanges();
  HeartDesign design = HeartDesign::polynomial(ranges);
  // 59 terms of nine dials, three of each of the seven of the sections, and a fifth more.
  EXPECT_EQ(design.size(), 96u);
  for (int round = 0; round < 2; ++round) {
    for (int n = 0; n < 50; ++n) {
      const std::vector<double> at = drawnWithin(ranges, n);
      const std::vector<float> shares = design.shares(at);
      double sum = 0, one = 0, size = 0;
      for (std::size_t i = 0; i < shares.size(); ++i) {
        sum += static_cast<double>(shares[i]) * f(design.at(i));
        one += static_cast<double>(shares[i]);
        size += std::abs(static_cast<double>(shares[i]));
      }
      EXPECT_NEAR(sum, f(at), 1e-4);
      EXPECT_NEAR(one, 1, 1e-5);
      EXPECT_LE(size, design.overshoot());
    }
    design.moveIn(7);
    design.moveIn(19);
    design.settle();
  }
}

TEST(FitDesign, AGridInterpolatesAtItsPlaces) {
  const HeartDesign grid = HeartDesign::grid({{"ef", 0.3, 0.7}, {"edv", 80, 220}}, 3);
  ASSERT_EQ(grid.size(), 9u);
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const std::vector<float> shares = grid.shares(grid.at(n));
    for (std::size_t i = 0; i < shares.size(); ++i)
      EXPECT_NEAR(shares[i], i == n ? 1 : 0, 1e-6) << n << " " << i;
  }
  EXPECT_NEAR(grid.at(1)[0], 0.5, 1e-12);  // the first dial fastest
  EXPECT_NEAR(grid.at(1)[1], 80, 1e-12);
}

// That of the ground truth, from meshes and material points.
double strainOfMeshes(const heart::Parameters& parameters) {
  Scene scene = heart::heartScene(parameters, heart::View::a4c, 12, Look::paper);
  scene.truth.function = true;
  const MeshMotion motion(scene);
  const MotionField field = interiorMotion(scene, motion);
  const HeartFunction function(scene, motion, field, 0);
  SurfaceFrame surfaces;
  FieldFrame frame;
  const double end_systole = scene.motion.end_systole_phase.value();
  motion.frameAt(end_systole, surfaces);
  field.at(end_systole, frame);
  return function.at(surfaces, frame).global_longitudinal_strain;
}

TEST(FitStrain, IsCloseToTheGroundTruthOfMeshes) {
  for (const auto& dials :
       {std::map<std::string, double>{}, {{"ef", 0.35}, {"edv", 180}, {"mapse", 7}}}) {
    const heart::Parameters parameters = heart::parametersFrom(dials);
    const double strain = longitudinalStrainOf(parameters), truth = strainOfMeshes(parameters);
    EXPECT_NEAR(strain, truth, 0.015);
    EXPECT_LT(strain, -0.05);
  }
}

// 0 at end-diastole, most negative near end-systole, and more negative with more excursion.
TEST(FitStrain, FollowsTheBeat) {
  const heart::Parameters parameters = heart::parametersFrom({{"ef", 0.6}});
  const double end = heart::Cycle(parameters).events().aortic_closes;
  const std::vector<double> strains = longitudinalStrains(parameters, {0, 0.5 * end, end});
  EXPECT_EQ(strains[0], 0);
  EXPECT_LT(strains[1], 0);
  EXPECT_LT(strains[2], strains[1]);
  EXPECT_EQ(strains[2], longitudinalStrainOf(parameters));
  EXPECT_LT(longitudinalStrainOf(heart::parametersFrom({{"ef", 0.6}, {"mapse", 15}})),
            longitudinalStrainOf(heart::parametersFrom({{"ef", 0.6}, {"mapse", 10}})));
}

}  // namespace
}  // namespace echocine::fit
