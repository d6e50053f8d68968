// Interfaces that one pulse holds echo as the exact layer does; what one wall sends back at most.

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "signal/beam_width.h"
#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

constexpr double kFrequency = 2.5e6;

// r of Eq. 1 between two media, by amplitude.
double amplitude(const Medium& a, const Medium& b, double cos_i, double cos_t) {
  const double to = b.impedance_kg_m2_s * cos_i, from = a.impedance_kg_m2_s * cos_t;
  return (to - from) / (to + from);
}

double refractedCosine(double cos_i, const Medium& from, const Medium& to) {
  const double sin_t = std::sqrt(1 - cos_i * cos_i) * to.sound_speed_m_s / from.sound_speed_m_s;
  return std::sqrt(1 - sin_t * sin_t);
}

// The share of a gated sine's energy that a layer sends back: its exact reflection (all echoes
// within it) at every frequency, weighed by the pulse's spectrum.
double exactLayer(const Medium& around, const Medium& layer, double thickness_m, double cos_i,
                  double cycles) {
  const double cos_t = refractedCosine(cos_i, around, layer);
  const double r = amplitude(around, layer, cos_i, cos_t);
  const double delay_s = 2 * thickness_m * cos_t / layer.sound_speed_m_s;
  double energy = 0, back = 0;
  constexpr int kSteps = 200000;
  for (int i = 0; i < kSteps; ++i) {
    const double f = 20.0 * (i + 0.5) / kSteps;  // in centre frequencies
    const double wave = std::sin(std::numbers::pi * cycles * f), gap = f * f - 1;
    const double power = std::abs(gap) < 1e-9 ? std::pow(std::numbers::pi * cycles / 2, 2)
                                              : wave * wave / (gap * gap);
    const std::complex<double> turn =
        std::polar(1.0, 2 * std::numbers::pi * kFrequency * f * delay_s);
    back += power * std::norm(r * (1.0 - turn) / (1.0 - r * r * turn));
    energy += power;
  }
  return back / energy;
}

// What the walk sends back from a layer whose faces the line meets at cos_i.
double walkedLayer(const Scene& scene, double thickness_m, double cos_i) {
  TraceSettings settings = straightSettings(scene);
  settings.reflection_cap = false;  // the exact layer is a mirror
  const Crossing front = crossingAt(0.05, 0, true, cos_i);
  Crossing back = crossingAt(0.05 + thickness_m / cos_i, 0, false, cos_i);
  back.normal = -front.normal;  // faces in parallel
  const LineTrace line = walkStraight(settings, {front, back});
  double sum = 0;
  for (const Echo& echo : line.echoes) sum += echo.intensity;
  return sum;
}

Scene layerScene(const Medium& layer) {
  Scene scene = plainScene({medium("tissue", 1060, 1584), layer});
  addStructure(scene, 1, 1);
  scene.structures[0].reflection_exponent = 0;
  return scene;
}

TEST(ThinLayer, EchoesAsTheExactLayerDoesFromATenthOfAMicrometreToTheThirdOfAMillimetre) {
  for (const Medium& layer : {medium("valve", 1120, 1584), medium("fat", 950, 1462)}) {
    const Scene scene = layerScene(layer);
    for (const double degrees : {0.0, 30.0, 60.0})
      for (const double um : {0.1, 0.7, 3.0, 10.0, 30.0, 60.0, 100.0, 150.0, 200.0, 300.0}) {
        const double cos_i = std::cos(radiansFromDegrees(degrees));
        const double exact =
            exactLayer(scene.media[0], scene.media[1], um * 1e-6, cos_i, scene.signal.pulse_cycles);
        const double walked = walkedLayer(scene, um * 1e-6, cos_i);
        EXPECT_NEAR(10 * std::log10(walked / exact), 0, 0.5)
            << layer.name << ' ' << um << " um at " << degrees << " degrees";
      }
  }
}

TEST(ThinLayer, SendsBackNothingAsItGoesAndTakesNothingFromWhatIsBehind) {
  const Scene scene = layerScene(medium("bone", 1862, 3194));
  const LineTrace line = walkStraight(
      straightSettings(scene), {crossingAt(0.05, 0, true), crossingAt(0.05 + 2e-7, 0, false)});
  ASSERT_EQ(line.echoes.size(), 2u);
  const double k = 2 * std::numbers::pi * kFrequency / 3194;
  const double R = std::pow(amplitude(scene.media[0], scene.media[1], 1, 1), 2);
  const double exact = 4 * std::pow(std::sin(k * 2e-7), 2) * R / std::pow(1 - R, 2);  // Airy, small
  EXPECT_NEAR((line.echoes[0].intensity + line.echoes[1].intensity) / exact, 1, 0.05);
}

// Beyond the pulse's half length the faces are apart.
TEST(ThinLayer, IsTwoWallsWhenThePulseIsShorter) {
  const Scene scene = layerScene(medium("valve", 1120, 1584));
  const double R = std::pow(amplitude(scene.media[0], scene.media[1], 1, 1), 2);
  const LineTrace line = walkStraight(straightSettings(scene),
                                      {crossingAt(0.05, 0, true), crossingAt(0.051, 0, false)});
  ASSERT_EQ(line.echoes.size(), 2u);
  EXPECT_NEAR(line.echoes[0].intensity, R, 1e-15);
  EXPECT_NEAR(line.echoes[1].intensity, R * (1 - R) * (1 - R), 1e-15);
}

// Two interfaces of three media merge into the one of the outer two.
TEST(ThinLayer, BetweenUnlikeMediaBecomesTheirInterface) {
  Scene scene = plainScene(
      {medium("blood", 1060, 1584), medium("sheath", 1110, 1584), medium("wall", 1200, 1584)});
  addStructure(scene, 1, 1);
  addStructure(scene, 2, 2);
  const LineTrace line = walkStraight(
      straightSettings(scene), {crossingAt(0.05, 0, true), crossingAt(0.05 + 1e-6, 1, true)});
  const double direct = std::pow(amplitude(scene.media[0], scene.media[2], 1, 1), 2);
  double sum = 0;
  for (const Echo& echo : line.echoes) sum += echo.intensity;
  EXPECT_NEAR(sum / direct, 1, 0.01);
}

// Section 2.1's W is at most R at normal incidence: fat to muscle outshines itself elsewhere.
TEST(ReflectionCap, NoAngleOutshinesNormalIncidence) {
  Scene scene = layerScene(medium("fat", 927, 1462));
  std::swap(scene.media[0], scene.media[1]);  // from fat into faster tissue: a critical angle
  const double Z_1 = scene.media[0].impedance_kg_m2_s, Z_2 = scene.media[1].impedance_kg_m2_s;
  const double upright = std::pow((Z_2 - Z_1) / (Z_2 + Z_1), 2);
  bool capped = false;
  for (int degrees = 0; degrees < 90; ++degrees) {
    const double cos_i = std::cos(radiansFromDegrees(degrees));
    const double R = interfaceLaw(Z_1, 1462, Z_2, 1584, cos_i).R;
    const LineTrace line =
        walkStraight(straightSettings(scene), {crossingAt(0.05, 0, true, cos_i)});
    ASSERT_EQ(line.echoes.size(), 1u);
    EXPECT_NEAR(line.echoes[0].intensity, std::min(R, upright), 1e-15) << degrees;
    TraceSettings mirror = straightSettings(scene);
    mirror.reflection_cap = false;
    EXPECT_NEAR(walkStraight(mirror, {crossingAt(0.05, 0, true, cos_i)}).echoes[0].intensity, R,
                1e-15);
    capped = capped || R > 2 * upright;
  }
  EXPECT_TRUE(capped);
}

// What stands in the picture behind the average over the pulse, wall against tissue.
TEST(EchoLength, WallAgainstTissueIsTheSameAtAnySpacing) {
  Scene scene =
      plainScene({medium("tissue", 1060, 1584, 0, 1e-3), medium("wall", 1200, 1584, 0, 1e-3)});
  addStructure(scene, 1, 1);
  scene.output.channels = {Channel::unattenuated};
  for (const int samples : {256, 512, 1000, 2048, 8192}) {
    scene.probe.samples = samples;
    const EffectPlan plan = planEffects(scene);
    const PlaneRequest request = planeRequest(scene, plan);
    const LineTrace line = walkStraight(straightSettings(scene), {crossingAt(0.0801, 0, true)});
    std::vector<float> values = intensityOf(line, samplingOf(scene.probe), request.intensity_terms);
    const BeamAverage average(scene.probe, scene.signal);
    average.apply(values);
    const float wall = *std::max_element(values.begin(), values.end());
    const float tissue = values[values.size() / 4];
    const double exact = line.echoes[0].intensity / static_cast<double>(tissue) + 1;
    EXPECT_NEAR(10 * std::log10(static_cast<double>(wall / tissue) / exact), 0, 0.1) << samples;
  }
}

// In the stack the echo's height times its sample's length stays.
TEST(EchoLength, TheStacksSumOverDepthIsTheSameAtAnySpacing) {
  Scene scene = layerScene(medium("valve", 1120, 1584));
  scene.output.channels = {Channel::reflection};
  const LineTrace line = walkStraight(straightSettings(scene), {crossingAt(0.0801, 0, true)});
  const double pulse_m = scene.signal.pulse_cycles * kScannerSpeed / kFrequency / 2;
  for (const int samples : {512, 1024, 4096}) {
    scene.probe.samples = samples;
    IntensityTerms parts = partsOf(Channel::unattenuated, false, 0);
    parts.echo_samples = planeRequest(scene, planEffects(scene)).echo_samples;
    double sum = 0;
    for (const float value : intensityOf(line, samplingOf(scene.probe), parts))
      sum += static_cast<double>(value) * scene.probe.sampleSpacing();
    EXPECT_NEAR(sum / (line.echoes[0].intensity * pulse_m), 1, 1e-6);
  }
}

// 1/l^2 stays what it is a wavelength away.
TEST(NearTheTransducer, SpreadEndsAtAWavelength) {
  Scene scene = plainScene({medium("tissue", 1060, 1584, 0, 1e-3)});
  scene.probe.max_depth_m = 0.01;
  scene.probe.samples = 10000;
  const LineTrace line = walkStraight(straightSettings(scene), {});
  Sampling sampling = samplingOf(scene.probe);
  sampling.spread_from_m = kScannerSpeed / kFrequency;
  const std::vector<float> values = intensityOf(line, sampling);
  for (int k = 0; k < 10000; ++k) {
    const double l = std::max(sampling.centre(k), sampling.spread_from_m);
    EXPECT_NEAR(static_cast<double>(values[static_cast<std::size_t>(k)]) * l * l / 1e-9, 1, 1e-5);
  }
}

// A membrane of a slower material: the second echo comes at the angle inside the sheet.
TEST(Membrane, EachOfItsEchoesHasItsOwnAngle) {
  Scene scene = plainScene({medium("blood", 1060, 1584), medium("sheet", 1120, 1200)});
  addStructure(scene, 1, 0, true);
  const double cos_i = 0.5, cos_t = refractedCosine(cos_i, scene.media[0], scene.media[1]);
  const double R = std::pow(amplitude(scene.media[0], scene.media[1], cos_i, cos_t), 2);
  const double Z_1 = scene.media[0].impedance_kg_m2_s, Z_2 = scene.media[1].impedance_kg_m2_s;
  const double back = std::min(R, std::pow((Z_2 - Z_1) / (Z_2 + Z_1), 2));
  const LineTrace line = walkStraight(straightSettings(scene), {crossingAt(0.05, 0, true, cos_i)});
  ASSERT_EQ(line.echoes.size(), 2u);
  EXPECT_NEAR(line.echoes[0].intensity, back * cos_i * cos_i, 1e-15);
  EXPECT_NEAR(line.echoes[1].intensity, (1 - R) / (1 + R) * back * cos_t * cos_t, 1e-15);
}

// What a sheet sends back and lets through, followed from face to face: intensities that add.
struct SheetEnergy {
  double back = 0, through = 0;
};
SheetEnergy reverberated(double R) {
  SheetEnergy sum{R, 0};
  double inside = 1 - R;
  for (int face = 1; face < 400; ++face) {
    (face % 2 == 1 ? sum.through : sum.back) += inside * (1 - R);
    inside *= R;
  }
  return sum;
}

// Calcified leaflets too, whose faces are strong; up to near the critical angle of 29.7 degrees.
TEST(Membrane, SoundReverberatesBetweenItsFaces) {
  for (const Medium& sheet : {medium("valve", 1120, 1584), medium("calcified", 1862, 3194)}) {
    Scene scene = plainScene({medium("blood", 1060, 1584, 0, 1e-3), sheet});
    addStructure(scene, 1, 0, true);
    scene.structures[0].reflection_exponent = 0;
    TraceSettings settings = straightSettings(scene);
    settings.reflection_cap = false;
    for (const double degrees : {0.0, 6.0, 15.0, 25.0, 29.0}) {
      const double cos_i = std::cos(radiansFromDegrees(degrees));
      const double R = std::pow(
          amplitude(scene.media[0], sheet, cos_i, refractedCosine(cos_i, scene.media[0], sheet)),
          2);
      const SheetEnergy exact = reverberated(R);
      EXPECT_NEAR(exact.back + exact.through, 1, 1e-12);
      const LineTrace line = walkStraight(settings, {crossingAt(0.05, 0, true, cos_i)});
      ASSERT_EQ(line.echoes.size(), 2u);
      const double back = line.echoes[0].intensity + line.echoes[1].intensity;
      EXPECT_NEAR(back / exact.back, 1, 1e-9) << sheet.name << ' ' << degrees;
      const double lost =
          line.segments.back().strength_m2_sr / line.segments.front().strength_m2_sr;
      EXPECT_NEAR(lost / (exact.through * exact.through), 1, 1e-9) << sheet.name << ' ' << degrees;
    }
  }
}

}  // namespace
}  // namespace echocine
