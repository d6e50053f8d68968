// Range, attenuation and compression swept to their ends: l -> 0, exp past the smallest float, the
// logarithm of nothing.

#include <gtest/gtest.h>

#include "signal/log_compression.h"
#include "support/plain_scene.h"
#include "support/sweep.h"

namespace echocine {
namespace {

using namespace support;

constexpr double kSmallestFloat = std::numeric_limits<float>::min();

// 1/l^2 from the face on, where the last sample above 0 is still finite.
TEST(PropagationSweep, TheSpreadDownToTheFace) {
  Sweep sweep("l -> 0: eta V / l^2", "closed form", "l, m", 1e-6);
  const Scene scene = plainScene({medium("a", 1000, 1500, 0, 1e-3)});
  const LineTrace line = walkStraight(straightSettings(scene), {});
  for (const double l : decades(1e-9, 0.15, 2000)) {
    const float got = intensityOf(line, {0, 2 * l, 1})[0];
    sweep.add(l, got, 1e-9L / (static_cast<long double>(l) * l));
  }
}

// A line of samples with path length l each, alpha so that A runs from nothing past underflow.
TEST(PropagationSweep, AttenuationPastTheSmallestFloat) {
  Sweep received("attenuation past underflow: Y", "closed form", "A, Np", 1e-5, kSmallestFloat);
  Sweep unattenuated("attenuation past underflow: perfect TGC", "closed form", "A, Np", 1e-6);
  Sweep exponent("attenuation past underflow: A", "closed form", "A, Np", 1e-6);
  for (const double alpha : decades(1e-3, 1e6, 60)) {
    Scene scene = plainScene({medium("a", 1000, 1500, alpha, 0.1)});
    scene.probe.samples = 400;
    const LineTrace line = walkStraight(straightSettings(scene), {});
    const Sampling sampling = samplingOf(scene.probe);
    IntensityTerms perfect;
    perfect.attenuation = false;
    const std::vector<float> y = intensityOf(line, sampling),
                             free = intensityOf(line, sampling, perfect);
    std::vector<float> a(y.size());
    sampleExponent(line, sampling, a);
    for (int k = 0; k < sampling.samples; ++k) {
      const long double l = sampling.centre(k), A = 4 * static_cast<long double>(alpha) * l;
      const auto i = static_cast<std::size_t>(k);
      received.add(A, y[i], 1e-7L / (l * l) * std::exp(-A));
      unattenuated.add(A, free[i], 1e-7L / (l * l));
      exponent.add(A, a[i], A);
    }
  }
}

// The same through 30 layers: what is begun in a medium deep under the smallest float's root.
TEST(PropagationSweep, AttenuationPastTheSmallestFloatThroughManyMedia) {
  Sweep received("attenuation past underflow, 30 media: Y", "closed form", "A, Np", 1e-5,
                 kSmallestFloat);
  for (const double alpha : decades(10, 1e4, 20)) {
    std::vector<Medium> media;
    for (int i = 0; i < 31; ++i)
      media.push_back(medium("m", 1000, 1500, alpha * (1 + i % 3), 0.1 * (1 + i % 2)));
    Scene scene = plainScene(media);
    scene.probe.samples = 1600;
    std::vector<Crossing> crossings;
    for (int i = 1; i <= 30; ++i) {
      addStructure(scene, static_cast<std::size_t>(i), i);
      crossings.push_back(crossingAt(0.0051 * i, static_cast<std::uint32_t>(i - 1), true));
    }
    const LineTrace line = walkStraight(letterSettings(scene), crossings);
    const Sampling sampling = samplingOf(scene.probe);
    const std::vector<float> y = intensityOf(line, sampling);
    for (int k = 0; k < sampling.samples; ++k) {
      const long double l = sampling.centre(k);
      const int last = std::min(static_cast<int>(l / 0.0051L), 30);
      long double A = 0;
      for (int i = 0; i <= last; ++i)
        A += 4 * static_cast<long double>(alpha) * (1 + i % 3) *
             (std::min(l, 0.0051L * (i + 1)) - 0.0051L * i);
      if (last == 30)
        A += 4 * static_cast<long double>(alpha) * (l - 0.0051L * 31 > 0 ? l - 0.0051L * 31 : 0);
      received.add(A, y[static_cast<std::size_t>(k)],
                   1e-7L * (1 + last % 2) / (l * l) * std::exp(-A));
    }
  }
}

// From the largest float to the smallest denormal, and 0.
TEST(PropagationSweep, TheLogarithmDownToNothing) {
  // Grey is a share of the dynamic range; 1e-5 of 60 dB is a hundredth of a grey level's 1/256.
  Sweep sweep("log of 0 and of every power of ten", "long double log10", "intensity", 1e-5, 1);
  for (const double reference : {1.0, 1e-6, 1e-20, 1e10})
    for (const double range_db : {1.0, 60.0, 300.0}) {
      std::vector<float> in{0.0f};
      for (const double I : decades(kSmallestFloat, 3e38, 2000))
        in.push_back(static_cast<float>(I));
      for (const double end : {reference, reference * std::pow(10, -range_db / 10)})
        for (const double I :
             {std::nextafter(static_cast<float>(end), 0.0f), static_cast<float>(end)})
          in.push_back(static_cast<float>(I));
      std::vector<float> grey(in.size());
      compressIntensities(in, reference, range_db, grey);
      for (std::size_t i = 0; i < in.size(); ++i) {
        const long double exact =
            in[i] >= kSmallestFloat
                ? 1 + 10 * std::log10(in[i] / static_cast<long double>(reference)) / range_db
                : 0;
        // The logarithm is good to 6e-6 dB within 1e-12..1 and to 1e-4 dB over all floats.
        const double scale = std::min(1.0, range_db / 60);
        sweep.add(in[i], scale * grey[i], scale * std::clamp(exact, 0.0L, 1.0L));
      }
    }
}

}  // namespace
}  // namespace echocine
