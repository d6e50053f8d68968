// One scan line through media: who wins where structures overlap, what vanishes, what ends the
// line.

#include "trace/line_walker.h"

#include <gtest/gtest.h>

#include "support/plain_scene.h"
#include "trace/interface_law.h"

namespace echocine {
namespace {

using namespace support;

constexpr std::size_t kOutside = 0, kMuscle = 1, kBlood = 2, kFast = 3, kTwin = 4;

Scene heartScene() {
  Scene scene =
      plainScene({medium("outside", 1050, 1540, 5, 0.1), medium("muscle", 1100, 1580, 8, 0.3),
                  medium("blood", 1060, 1570, 2, 0.001), medium("fast", 1100, 1900, 8, 0.3),
                  medium("twin", 1050, 1540, 9, 0.2)});
  scene.output.channels = {kAllChannels.begin(), kAllChannels.end()};
  return scene;
}

double reflectanceOf(const Scene& s, std::size_t from, std::size_t to, double cos_i = 1) {
  return interfaceLaw(s.media[from].impedance_kg_m2_s, s.media[from].sound_speed_m_s,
                      s.media[to].impedance_kg_m2_s, s.media[to].sound_speed_m_s, cos_i)
      .R;
}

std::vector<std::size_t> mediaOf(const LineTrace& line) {
  std::vector<std::size_t> ids;
  for (const MediumSegment& s : line.segments) ids.push_back(index(s.medium));
  return ids;
}

using Ids = std::vector<std::size_t>;

// Wall and cavity that slightly overlap, wall first: entered 30 mm, cavity 40..60 mm, left at 70
// mm.
std::vector<Crossing> nested() {
  return {crossingAt(0.03, 0, true), crossingAt(0.04, 1, true), crossingAt(0.06, 1, false),
          crossingAt(0.07, 0, false)};
}

TEST(LineWalker, TheHigherPriorityWinsInsideAnother) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  addStructure(scene, kBlood, 2);
  EXPECT_EQ(mediaOf(walkStraight(straightSettings(scene), nested())),
            (Ids{kOutside, kMuscle, kBlood, kMuscle, kOutside}));
}

TEST(LineWalker, TheLowerPriorityIsNotSeenInsideAnother) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 2);
  addStructure(scene, kBlood, 1);
  const LineTrace line = walkStraight(straightSettings(scene), nested());
  for (const MediumSegment& s : line.segments) EXPECT_NE(index(s.medium), kBlood);
  EXPECT_EQ(line.echoes.size(), 2u);
}

TEST(LineWalker, AmongEqualPrioritiesTheLaterStructureWins) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 5);
  addStructure(scene, kBlood, 5);
  EXPECT_EQ(mediaOf(walkStraight(straightSettings(scene), nested())),
            (Ids{kOutside, kMuscle, kBlood, kMuscle, kOutside}));
}

// prod (1-R)^2 over those before it, and A up to it.
TEST(LineWalker, EachEchoCarriesTheLossesBeforeIt) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  addStructure(scene, kBlood, 2);
  const LineTrace line = walkStraight(straightSettings(scene), nested());
  const double a = reflectanceOf(scene, kOutside, kMuscle),
               b = reflectanceOf(scene, kMuscle, kBlood);
  ASSERT_EQ(line.echoes.size(), 4u);
  EXPECT_DOUBLE_EQ(line.echoes[0].intensity, a);
  EXPECT_DOUBLE_EQ(line.echoes[1].intensity, b * std::pow(1 - a, 2));
  EXPECT_DOUBLE_EQ(line.echoes[2].intensity, b * std::pow(1 - a, 2) * std::pow(1 - b, 2));
  EXPECT_DOUBLE_EQ(line.echoes[3].intensity, a * std::pow(1 - a, 2) * std::pow(1 - b, 4));
  EXPECT_DOUBLE_EQ(line.echoes[1].exponent, 4 * (5 * 0.03 + 8 * 0.01));
  EXPECT_DOUBLE_EQ(line.echoes[3].depth_m, 0.07);
}

// W and n shape what comes back; what goes on is (1-R) whatever they are.
TEST(LineWalker, GainAndExponentShapeTheEchoAndNotTheLoss) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  scene.structures[0].reflection_gain = 7;
  scene.structures[0].reflection_exponent = 3;
  const LineTrace line = walkStraight(straightSettings(scene), {crossingAt(0.03, 0, true, 0.8)});
  const double R = reflectanceOf(scene, kOutside, kMuscle, 0.8);
  const double W = std::min(R, reflectanceOf(scene, kOutside, kMuscle));
  EXPECT_NEAR(line.echoes[0].intensity, 7 * W * 0.8 * 0.8 * 0.8, 1e-15);
  EXPECT_NEAR(line.segments[1].strength_m2_sr, 0.3 * 1e-6 * (1 - R) * (1 - R), 1e-20);
}

TEST(LineWalker, EqualMediaHaveNoInterface) {
  Scene scene = heartScene();
  addStructure(scene, kTwin, 1);
  const LineTrace line = walkStraight(straightSettings(scene),
                                      {crossingAt(0.03, 0, true, 0.1), crossingAt(0.05, 0, false)});
  EXPECT_TRUE(line.echoes.empty());
  EXPECT_EQ(mediaOf(line), (Ids{kOutside, kTwin, kOutside}));
  EXPECT_EQ(line.segments[1].strength_m2_sr, 0.2 * 1e-6);
}

// A ten-thousandth of a wavelength: no layer that thin sends anything back.
TEST(LineWalker, CoincidentWallsAreOneInterfaceOfTheOuterMedia) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  addStructure(scene, kBlood, 2);
  for (const double apart : {0.0, 1e-12, 5e-8})
    for (const bool swapped : {false, true}) {
      const LineTrace line =
          walkStraight(straightSettings(scene), {crossingAt(0.04, swapped ? 1 : 0, true),
                                                 crossingAt(0.04 + apart, swapped ? 0 : 1, true)});
      ASSERT_EQ(line.echoes.size(), 1u) << apart;
      EXPECT_DOUBLE_EQ(line.echoes[0].intensity, reflectanceOf(scene, kOutside, kBlood));
      EXPECT_EQ(mediaOf(line), (Ids{kOutside, kBlood}));
    }
}

// Where surfaces coincide, the echo has the normal of the one with the higher priority.
TEST(LineWalker, OfCoincidentWallsTheHigherPriorityHasTheNormal) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  addStructure(scene, kBlood, 2);
  const TraceSettings settings = straightSettings(scene);
  const Crossing muscle = crossingAt(0.04, 0, true), blood = crossingAt(0.04, 1, true, 0.9);
  const double wanted = walkStraight(settings, {blood}).echoes.at(0).intensity;
  EXPECT_LT(wanted, 0.95 * reflectanceOf(scene, kOutside, kBlood));
  for (const std::vector<Crossing>& met : {std::vector{muscle, blood}, std::vector{blood, muscle}})
    EXPECT_DOUBLE_EQ(walkStraight(settings, met).echoes.at(0).intensity, wanted);
}

TEST(LineWalker, TouchingStructuresPassTheRayWithoutAGap) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  addStructure(scene, kBlood, 1);
  const LineTrace line = walkStraight(straightSettings(scene),
                                      {crossingAt(0.03, 0, true), crossingAt(0.05, 0, false),
                                       crossingAt(0.05, 1, true), crossingAt(0.08, 1, false)});
  EXPECT_EQ(mediaOf(line), (Ids{kOutside, kMuscle, kBlood, kOutside}));
  EXPECT_EQ(line.echoes.size(), 3u);
}

TEST(LineWalker, AThinWallThatIsThickerThanAThousandthOfAWavelengthStays) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  const LineTrace line = walkStraight(
      straightSettings(scene), {crossingAt(0.04, 0, true), crossingAt(0.04 + 5e-6, 0, false)});
  EXPECT_EQ(line.echoes.size(), 2u);
}

TEST(LineWalker, AMembraneReflectsTwiceAndEnclosesNothing) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 0, true);
  for (const bool front : {true, false}) {
    const LineTrace line = walkStraight(straightSettings(scene), {crossingAt(0.05, 0, front, 0.9)});
    const double R = reflectanceOf(scene, kOutside, kMuscle, 0.9);
    const double W = std::min(R, reflectanceOf(scene, kOutside, kMuscle));
    const double sin_t = std::sqrt(1 - 0.81) * 1580 / 1540, cos_t2 = 1 - sin_t * sin_t;
    ASSERT_EQ(line.echoes.size(), 2u);
    EXPECT_DOUBLE_EQ(line.echoes[0].intensity, W * 0.81);
    EXPECT_NEAR(line.echoes[1].intensity, W * cos_t2 * (1 - R) / (1 + R), 1e-15);
    EXPECT_EQ(mediaOf(line), (Ids{kOutside, kOutside}));
    EXPECT_NEAR(line.segments[1].strength_m2_sr, 0.1 * 1e-6 * std::pow((1 - R) / (1 + R), 2),
                1e-20);
  }
}

// A ray through a sheet's vertex meets several of its triangles at one distance.
// A vertex belongs to several triangles, and the sheet is still passed once.
TEST(LineWalker, AMembraneMetBySeveralTrianglesInAVertexReflectsAsIfMetByOne) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 0, true);
  const TraceSettings settings = straightSettings(scene);
  const Crossing front = crossingAt(0.05, 0, true), back = crossingAt(0.05, 0, false);
  const LineTrace once = walkStraight(settings, {front});
  for (const std::vector<Crossing>& met :
       {std::vector{front, back, front}, std::vector{front, front}}) {
    const LineTrace line = walkStraight(settings, met);
    ASSERT_EQ(line.echoes.size(), once.echoes.size());
    EXPECT_EQ(line.echoes[1].intensity, once.echoes[1].intensity);
    EXPECT_EQ(line.segments.back().strength_m2_sr, once.segments.back().strength_m2_sr);
  }
}

TEST(LineWalker, AMembraneInsideAStructureStandsInItsMedium) {
  Scene scene = heartScene();
  addStructure(scene, kBlood, 1);
  addStructure(scene, kMuscle, 0, true);
  const LineTrace line =
      walkStraight(straightSettings(scene), {crossingAt(0.03, 0, true), crossingAt(0.05, 1, true)});
  const double in = reflectanceOf(scene, kOutside, kBlood),
               R = reflectanceOf(scene, kBlood, kMuscle);
  ASSERT_EQ(line.echoes.size(), 3u);
  EXPECT_DOUBLE_EQ(line.echoes[1].intensity, R * (1 - in) * (1 - in));
}

TEST(LineWalker, TotalReflectionEndsTheLineWithExactZeros) {
  Scene scene = heartScene();
  addStructure(scene, kFast, 1);
  const double beyond = std::cos(std::asin(1540.0 / 1900) + 1e-6);
  const LineTrace line = walkStraight(
      straightSettings(scene), {crossingAt(0.05, 0, true, beyond), crossingAt(0.09, 0, false)});
  ASSERT_EQ(line.echoes.size(), 1u);
  EXPECT_DOUBLE_EQ(line.echoes[0].intensity,
                   reflectanceOf(scene, kOutside, kFast) * beyond * beyond);
  const std::vector<float> values = intensityOf(line, samplingOf(scene.probe));
  EXPECT_GT(values[49], 0.0f);
  EXPECT_GT(values[50], 0.0f);  // the interface's own sample
  for (std::size_t k = 51; k < values.size(); ++k) EXPECT_EQ(values[k], 0.0f);
  std::vector<std::uint32_t> ids(values.size());
  sampleMedium(line, samplingOf(scene.probe), ids);
  EXPECT_EQ(ids[49], kOutside);
  EXPECT_EQ(ids[51], kNoMedium);
}

TEST(LineWalker, StartsInTheMediumThatHoldsTheProbe) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  addStructure(scene, kBlood, 2);
  InsideSet inside;
  inside[0] = inside[1] = true;
  const LineTrace line = walkStraight(
      straightSettings(scene), {crossingAt(0.02, 1, false), crossingAt(0.04, 0, false)}, inside);
  EXPECT_EQ(mediaOf(line), (Ids{kBlood, kMuscle, kOutside}));
  EXPECT_EQ(line.echoes.size(), 2u);
}

// A scanner takes 1540 m/s for all of the path, so what lies behind a faster medium stands too
// near.
TEST(LineWalker, TravelTimePlacesEchoesByTheScannersSpeed) {
  Scene scene = heartScene();
  addStructure(scene, kFast, 1);
  scene.effects.travel_time = Switch::on;
  const LineTrace line = walkStraight(straightSettings(scene),
                                      {crossingAt(0.03, 0, true), crossingAt(0.068, 0, false)});
  ASSERT_EQ(line.echoes.size(), 2u);
  EXPECT_NEAR(line.echoes[0].depth_m, 0.03, 1e-15);  // 1540 m/s up to there
  EXPECT_NEAR(line.echoes[1].depth_m, 0.03 + 0.038 * 1540 / 1900, 1e-15);
  EXPECT_NEAR(line.echoes[1].exponent, 4 * (5 * 0.03 + 8 * 0.038),
              1e-12);  // attenuation goes by path
  const MediumSegment& fast = line.segments[1];
  EXPECT_NEAR(fast.begin_path_m + fast.path_per_depth * (fast.end_depth_m - fast.begin_depth_m),
              0.068, 1e-15);
}

TEST(LineWalker, NothingIsSeenBeyondTheImage) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  const LineTrace line = walkStraight(straightSettings(scene),
                                      {crossingAt(0.159, 0, true), crossingAt(0.161, 0, false)});
  EXPECT_EQ(line.echoes.size(), 1u);
  EXPECT_EQ(line.segments.back().end_depth_m, scene.probe.max_depth_m);
}

TEST(LineWalker, SwitchedOffReflectionAndLossLeaveTheBackscatter) {
  Scene scene = heartScene();
  addStructure(scene, kMuscle, 1);
  scene.effects.reflection = scene.effects.transmission_loss = Switch::off;
  const LineTrace line = walkStraight(straightSettings(scene), {crossingAt(0.05, 0, true)});
  EXPECT_TRUE(line.echoes.empty());
  EXPECT_EQ(line.segments[1].strength_m2_sr, 0.3 * 1e-6);
}

}  // namespace
}  // namespace echocine
