// Regional wall motion: what one segment does is its own, and the ventricle as a whole keeps its
// ejection fraction.

#include <gtest/gtest.h>

#include "motion/heart/segment_shares.h"
#include "support/recorded_heart.h"

namespace echocine {
namespace {

using namespace support;
using heart::kSegments;

constexpr int kMidAnterior = 7;  // the Association's number
constexpr double kEjectionFraction = 0.5;

heart::Parameters withSegment(int number, double amplitude, double delay_s = 0) {
  heart::Parameters parameters = heart::parametersFrom({{"ef", kEjectionFraction}});
  parameters.segments[static_cast<std::size_t>(number - 1)] = {amplitude, delay_s};
  return parameters;
}

class Ventricle17 {
 public:
  explicit Ventricle17(const heart::Parameters& parameters)
      : cycle_(parameters), left_(parameters), at_rest_(pointsAt(0)) {}

  double endSystole() const { return cycle_.events().aortic_closes; }

  double ejectionFraction() {
    return 1 - fluxVolume({pointsAt(endSystole()), sphere_.faces}) /
                   fluxVolume({at_rest_, sphere_.faces});
  }

  // Motion since end-diastole towards the opposite wall, in m, of the point that then was nearest
  // to a segment's centre.
  double inwardMotion(int number, double phase) {
    const heart::SegmentPlace place = heart::segmentCentre(number - 1);
    left_.contract(cycle_.at(0).left);
    const Vec3d centre = left_.cavityAt(place.phi_rad, place.zeta);
    const Vec3d across = left_.cavityAt(place.phi_rad + std::numbers::pi, place.zeta);
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < at_rest_.size(); ++i)
      if (length(at_rest_[i] - centre) < length(at_rest_[nearest] - centre)) nearest = i;
    return dot(pointsAt(phase)[nearest] - at_rest_[nearest], normalised(across - centre));
  }
  double inwardAtEndSystole(int number) { return inwardMotion(number, endSystole()); }

  // The phase at which the wall is furthest in.
  double peakPhase(int number) {
    double best = 0, most = -1;
    for (double phase = 0.22; phase < 0.60; phase += 0.02) {
      const double now = inwardMotion(number, phase);
      if (now > most) {
        most = now;
        best = phase;
      }
    }
    return best;
  }

 private:
  std::vector<Vec3d> pointsAt(double phase) {
    left_.contract(cycle_.at(phase).left);
    return heart::pointsOn(sphere_, [this](Vec3d d) { return left_.cavityPoint(d); });
  }

  heart::SphereMesh sphere_ = heart::geodesicSphere(heart::LeftVentricle::kFrequency);
  heart::Cycle cycle_;
  heart::LeftVentricle left_;
  std::vector<Vec3d> at_rest_;
};

// The others take over its part: the ejection fraction is a dial of its own.
TEST(HeartSegments, AnAkineticOneStandsStillAndTheOthersKeepTheEjectionFraction) {
  Ventricle17 ill(withSegment(kMidAnterior, 0)), well(withSegment(kMidAnterior, 1));
  const double healthy_m = well.inwardAtEndSystole(kMidAnterior);
  EXPECT_GT(healthy_m, 3e-3);
  EXPECT_LT(std::abs(ill.inwardAtEndSystole(kMidAnterior)), 0.20 * healthy_m);
  EXPECT_GT(ill.inwardAtEndSystole(10), well.inwardAtEndSystole(10));  // opposite: does more
  EXPECT_NEAR(ill.ejectionFraction(), kEjectionFraction, 0.01);
  EXPECT_NEAR(well.ejectionFraction(), kEjectionFraction, 0.01);
}

TEST(HeartSegments, ADyskineticOneBulgesOutwards) {
  Ventricle17 ill(withSegment(kMidAnterior, -0.5)), well(withSegment(kMidAnterior, 1));
  EXPECT_LT(ill.inwardAtEndSystole(kMidAnterior), -0.2 * well.inwardAtEndSystole(kMidAnterior));
  EXPECT_NEAR(ill.ejectionFraction(), kEjectionFraction, 0.01);
}

TEST(HeartSegments, ADelayShiftsItsPeakByAsMuch) {
  constexpr double kDelay_s = 0.12;
  const heart::Parameters parameters = withSegment(kMidAnterior, 1, kDelay_s);
  const double delay = kDelay_s * parameters.heart_rate_bpm / 60;
  Ventricle17 late(parameters), prompt(withSegment(kMidAnterior, 1));
  const double shift = late.peakPhase(kMidAnterior) - prompt.peakPhase(kMidAnterior);
  std::printf("a delay of %.3f beats shifts the peak by %.3f\n", delay, shift);
  EXPECT_GT(shift, 0.4 * delay);
  EXPECT_LT(shift, 1.4 * delay);
  EXPECT_NEAR(late.ejectionFraction(), kEjectionFraction, 0.01);
}

// A partition of unity: moving all segments alike is moving the wall.
TEST(HeartSegments, SharesSumToOneAndAreSmooth) {
  constexpr double kStep = 1e-4;
  for (double zeta = -0.1; zeta < 1.05; zeta += 0.0137)
    for (double phi_rad = -7; phi_rad < 7; phi_rad += 0.0713) {
      const auto here = heart::segmentShares(phi_rad, zeta);
      const auto around = heart::segmentShares(phi_rad + 2 * std::numbers::pi, zeta);
      const auto a = heart::segmentShares(phi_rad + kStep, zeta),
                 b = heart::segmentShares(phi_rad - kStep, zeta),
                 c = heart::segmentShares(phi_rad, zeta + kStep),
                 d = heart::segmentShares(phi_rad, zeta - kStep);
      double sum = 0;
      for (std::size_t s = 0; s < kSegments; ++s) {
        sum += here[s];
        ASSERT_GE(here[s], 0);
        ASSERT_NEAR(here[s], around[s], 1e-9);
        // Once differentiable: slopes on either side agree to the second derivative, which is at
        // most 6 over the square of the least distance of two rings, 0.17.
        ASSERT_NEAR(a[s] - here[s], here[s] - b[s], 8 * kStep * kStep) << phi_rad << ' ' << zeta;
        ASSERT_NEAR(c[s] - here[s], here[s] - d[s], 220 * kStep * kStep) << phi_rad << ' ' << zeta;
      }
      ASSERT_NEAR(sum, 1, 1e-12);
    }
}

// The Association's map: basal, mid and apical rings, counted from the anterior wall by the septum.
TEST(HeartSegments, EachRulesAloneAtItsCentreWhereTheAssociationPutsIt) {
  constexpr double kAnterior = 60, kSeptal = 150, kInferior = 240;  // deg about the axis
  for (int s = 0; s < kSegments; ++s) {
    const heart::SegmentPlace place = heart::segmentCentre(s);
    EXPECT_NEAR(heart::segmentShares(place.phi_rad, place.zeta)[static_cast<std::size_t>(s)], 1,
                1e-12);
  }
  const auto ruler = [](double phi_deg, double zeta) {
    const auto shares = heart::segmentShares(phi_deg * std::numbers::pi / 180, zeta);
    return std::max_element(shares.begin(), shares.end()) - shares.begin() + 1;
  };
  EXPECT_EQ(ruler(kAnterior, 0.1), 1);
  EXPECT_EQ(ruler(kAnterior, 0.5), 7);
  EXPECT_EQ(ruler(kAnterior, 0.8), 13);
  EXPECT_EQ(ruler(kInferior, 0.1), 4);
  EXPECT_EQ(ruler(kInferior, 0.5), 10);
  EXPECT_EQ(ruler(kInferior, 0.8), 15);
  EXPECT_EQ(ruler(kSeptal, 0.8), 14);
  EXPECT_EQ(ruler(0, 0.5), 12);
  EXPECT_EQ(ruler(200, 1), 17);
}

double measuredEjection(const heart::ParametricHeart& model) {
  const auto cavity = [&](double phase) {
    for (const heart::Part& part : model.at(phase))
      if (part.kind.name == "lv_cavity") return fluxVolume({part.points, part.faces});
    return 0.0;
  };
  return 1 - cavity(model.cycle().events().aortic_closes) / cavity(0);
}

// Three still segments of an infarct: the others do no more than before.
TEST(HeartSegments, StillSegmentsLowerTheEjectionFractionUnlessVolumesRule) {
  heart::Parameters parameters = heart::parametersFrom({{"ef", 0.6}});
  EXPECT_NEAR(heart::ParametricHeart(parameters).parameters().ejection_fraction, 0.6, 1e-12);
  for (const int number : {7, 13, 17}) parameters.segments[number - 1].amplitude = 0;
  const heart::ParametricHeart infarct(parameters);
  EXPECT_LT(infarct.parameters().ejection_fraction, 0.57);
  EXPECT_GT(infarct.parameters().ejection_fraction, 0.40);
  EXPECT_NEAR(measuredEjection(infarct), infarct.parameters().ejection_fraction, 0.01);
  parameters.volumes_rule = true;
  const heart::ParametricHeart helped(parameters);
  EXPECT_EQ(helped.parameters().ejection_fraction, 0.6);
  EXPECT_NEAR(measuredEjection(helped), 0.6, 0.01);
}

}  // namespace
}  // namespace echocine
