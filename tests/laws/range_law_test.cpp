// Spread and the product form of section 4.1 against the paper's recursion.

#include <gtest/gtest.h>

#include "support/plain_scene.h"
#include "support/sweep.h"
#include "trace/interface_law.h"

namespace echocine {
namespace {

using namespace support;

// Eq. 4: 1/l^2.
TEST(RangeLaw, DoublingTheDistanceQuartersTheIntensity) {
  Scene scene = plainScene({medium("a", 1000, 1500, 0, 1)});
  const LineTrace line = walkStraight(straightSettings(scene), {});
  for (const double depth_m : {0.001, 0.02, 0.07}) {
    const float near = intensityOf(line, {depth_m - 5e-5, 1e-4, 1})[0];
    const float far = intensityOf(line, {2 * depth_m - 5e-5, 1e-4, 1})[0];
    EXPECT_NEAR(near / far, 4, 2e-6);
  }
}

// Eq. 4 with all its factors.
TEST(RangeLaw, BackscatterIsEtaTimesVolumeOverSquaredDistance) {
  Scene scene = plainScene({medium("a", 1000, 1500, 0, 0.25)});
  scene.unit_volume_m3 = 1e-6;
  const LineTrace line = walkStraight(straightSettings(scene), {});
  EXPECT_NEAR(intensityOf(line, {0.0999, 2e-4, 1})[0], 0.25 * 1e-6 / 0.01, 1e-11);
}

TEST(RangeLaw, TheCompensatedSpreadIsThatOfItsReferenceDistanceEverywhere) {
  Scene scene = plainScene({medium("a", 1000, 1500, 0, 0.25)});
  IntensityTerms parts;
  parts.spread_undone_at_m = 0.08;
  const LineTrace line = walkStraight(straightSettings(scene), {});
  for (const float value : intensityOf(line, samplingOf(scene.probe), parts))
    EXPECT_FLOAT_EQ(value, static_cast<float>(0.25e-6 / (0.08 * 0.08)));
}

// A path through many media: interface i leads into structure i.
struct Layers {
  Scene scene;
  std::vector<Crossing> crossings;

  Layers(int media, int samples, double alpha_scale) {
    std::vector<Medium> list;
    for (int i = 0; i < media; ++i)
      list.push_back(medium("m" + std::to_string(i), 1000 + 37 * (i * 7 % 11),
                            1500 + 3 * (i * 5 % 13), alpha_scale * (1 + i % 4),
                            0.1 + 0.03 * (i * 3 % 7)));
    scene = plainScene(list);
    scene.probe.samples = samples;
    for (int i = 1; i < media; ++i) {
      addStructure(scene, static_cast<std::size_t>(i), i);
      crossings.push_back(crossingAt(scene.probe.max_depth_m * (i - 0.013 * (i % 5)) / media,
                                     static_cast<std::uint32_t>(i - 1), true, 1 - 0.04 * (i % 9)));
    }
  }
};

struct Losses {
  long double there, back;
};

// Both transmissions of Eq. 2 at interface i, on the reverse forward path.
Losses lossesAt(const Layers& layers, std::size_t i) {
  const Medium& from = layers.scene.media[i];
  const Medium& to = layers.scene.media[i + 1];
  const long double cos_i = std::abs(layers.crossings[i].normal.z);
  const long double r = static_cast<long double>(to.sound_speed_m_s) / from.sound_speed_m_s;
  const long double cos_t = std::sqrt(1 - r * r * (1 - cos_i * cos_i));
  const long double sum = to.impedance_kg_m2_s * cos_i + from.impedance_kg_m2_s * cos_t;
  const long double common = 4.0L * from.impedance_kg_m2_s * to.impedance_kg_m2_s / (sum * sum);
  return {common * cos_i * cos_i, common * cos_t * cos_t};
}

// The paper's recursion: each sample from the one before, I_R(P') = l^2/(l + dl)^2 exp(-4 alpha dl)
// I_R(P) inside a medium; an interface in between adds its two transmissions and the other medium's
// eta_b.
std::vector<long double> recursion(const Layers& layers) {
  const Sampling sampling = samplingOf(layers.scene.probe);
  const std::vector<Medium>& media = layers.scene.media;
  std::vector<long double> values;
  std::size_t m = 0;
  long double l = 1e-3L;  // starts in the first medium with the equation of a single path
  long double value = media[0].backscatter_per_m_sr * 1e-6L / (l * l) *
                      std::exp(-4 * media[0].attenuation_np_per_m * l);
  const auto go = [&](long double to) {
    value *= l * l / (to * to) * std::exp(-4 * media[m].attenuation_np_per_m * (to - l));
    l = to;
  };
  for (int k = 0; k < sampling.samples; ++k) {
    while (m < layers.crossings.size() && layers.crossings[m].distance_m <= sampling.centre(k)) {
      go(layers.crossings[m].distance_m);
      const Losses loss = lossesAt(layers, m);
      value *= loss.there * loss.back * media[m + 1].backscatter_per_m_sr /
               media[m].backscatter_per_m_sr;
      ++m;
    }
    go(sampling.centre(k));
    values.push_back(value);
  }
  return values;
}

void expectRecursion(const char* name, const Layers& layers) {
  IntensityTerms parts;
  parts.reflection = false;
  const LineTrace line = walkStraight(letterSettings(layers.scene), layers.crossings);
  ASSERT_EQ(line.segments.size(), layers.scene.media.size());
  const std::vector<float> product = intensityOf(line, samplingOf(layers.scene.probe), parts);
  const std::vector<long double> expected = recursion(layers);
  Sweep sweep(name, "the paper's recursion, long double", "sample", 1e-6);
  for (std::size_t k = 0; k < product.size(); ++k)
    sweep.add(static_cast<double>(k), product[k], expected[k]);
}

// Section 4.1's recursion from sample to sample is the oracle of the product.
TEST(ProductForm, EqualsThePapersRecursionAlongFiveMedia) {
  expectRecursion("recursion, 5 media", Layers(5, 1000, 3));
}

// Rounding of either form must not grow with the samples.
TEST(ProductForm, EqualsThePapersRecursionOverTenThousandSamples) {
  expectRecursion("recursion, 1e4 samples", Layers(5, 10000, 10));
}

// Nor with the interfaces.
TEST(ProductForm, EqualsThePapersRecursionOverFiftyMedia) {
  expectRecursion("recursion, 1e4 samples and 50 media", Layers(50, 10000, 5));
}

}  // namespace
}  // namespace echocine
