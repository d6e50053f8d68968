// One layer's closed form against the sum over the spectrum, for layers from films to several
// pulses, whole and half cycles, and with what turns back fading out.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "trace/layer_series.h"
#include "trace/layer_spectrum.h"

namespace echocine {
namespace {

constexpr LayerMedium kTissue{1060 * 1584.0, 1584}, kFat{927 * 1462.0, 1462},
    kBone{1862 * 3194.0, 3194}, kLung{400 * 650.0, 650}, kMuscle{1065 * 1600.0, 1600};

LayerFaces facesOf(LayerMedium layer, LayerMedium after, double h_m, double degrees, double kept) {
  const Layer one{layer, h_m, kept};
  const double cos_0 = std::cos(degrees * std::numbers::pi / 180);
  return LayerFaces(kTissue, cos_0, std::span(&one, 1), after, 2.5e6);
}

// 0.01 dB, or a billionth of the pulse's energy.
void expectNear(double a, double b, const std::string& what) {
  EXPECT_NEAR(a, b, 0.0023 * b + 1e-9) << what;
}

TEST(LayerSeries, IsTheMeanOverTheSpectrum) {
  int in_closed_form = 0;
  for (const LayerMedium layer : {kFat, kBone, kLung, kMuscle})
    for (const LayerMedium after : {kTissue, kMuscle, kFat})
      for (const double um : {0.1, 1.0, 10.0, 50.0, 200.0, 500.0, 1500.0})
        for (const double degrees : {0.0, 20.0, 29.0, 60.0, 80.0})
          for (const double N : {1.0, 1.5, 2.0, 3.5})
            for (const double kept : {1.0, 0.4, 0.0}) {
              const LayerFaces faces = facesOf(layer, after, um * 1e-6, degrees, kept);
              const auto series = layerSeries(faces, N);
              if (!series) continue;
              ++in_closed_form;
              const StackResponse mean = spectrumMean(faces, N);
              const std::string what = std::to_string(layer.c) + ' ' + std::to_string(um) + ' ' +
                                       std::to_string(degrees) + ' ' + std::to_string(N);
              expectNear(series->reflected, mean.reflected, what);
              expectNear(series->passed_twice, mean.passed_twice, what);
            }
  EXPECT_GT(in_closed_form, 3000);
}

TEST(LayerSeries, LeavesEvanescentLayersStrongOnesAndStacksToTheSpectrum) {
  EXPECT_FALSE(layerSeries(facesOf(kBone, kTissue, 1e-4, 45, 1), 2));  // beyond its critical angle
  EXPECT_FALSE(layerSeries(facesOf(kFat, kBone, 1e-4, 45, 1), 2));     // a mirror behind it
  EXPECT_FALSE(layerSeries(facesOf(kLung, kTissue, 1e-4, 89.5, 1), 2));  // rings for long
  EXPECT_TRUE(layerSeries(facesOf(kFat, kTissue, 1e-4, 45, 1), 2));
  const std::array<Layer, 2> two{Layer{kFat, 1e-4, 1}, Layer{kMuscle, 1e-4, 1}};
  EXPECT_FALSE(layerSeries(LayerFaces(kTissue, 1, two, kTissue, 2.5e6), 2));
}

}  // namespace
}  // namespace echocine
