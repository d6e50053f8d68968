// Eqs. 1 and 2 and Snell's cosine, against their own laws and a long double oracle.

#include "trace/interface_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "trace/interface_lanes.h"

namespace echocine {
namespace {

struct Pair {
  double Z_1, c_1, Z_2, c_2;
};

// Soft tissue pairs, lung and bone, equal impedance or equal speed, and absurdly unlike media.
const std::vector<Pair> kPairs{{1.659e6, 1580, 1.679e6, 1584},
                               {1.679e6, 1584, 1.738e6, 1584},
                               {1.355e6, 1462, 1.679e6, 1584},
                               {1.659e6, 1580, 2.6e5, 650},
                               {1.659e6, 1580, 5.947e6, 3194},
                               {1.5e6, 1480, 1.5e6, 1600},
                               {1.5e6, 1600, 1.5e6, 1480},
                               {1.5e6, 1500, 1.5000001e6, 1500.0001},
                               {1, 1, 1e6, 1e3},
                               {1e6, 1e3, 1, 1}};

struct Exact {
  long double cos_t_squared, cos_t, R, T;
};

Exact exactly(const Pair& p, double cos_i) {
  const long double r = static_cast<long double>(p.c_2) / p.c_1, ci = cos_i;
  Exact e{};
  e.cos_t_squared = 1 - r * r * (1 - ci * ci);
  e.cos_t = std::sqrt(std::max(e.cos_t_squared, 0.0L));
  const long double a = p.Z_2 * ci, b = p.Z_1 * e.cos_t;
  const bool total = e.cos_t_squared <= 0 && r > 1;
  e.R = total ? 1 : a + b > 0 ? (a - b) / (a + b) * ((a - b) / (a + b)) : 0;
  e.T = total ? 0 : 4 * a * (p.Z_1 * ci) / ((a + b) * (a + b));
  return e;
}

std::vector<double> incidences() {
  std::vector<double> all;
  for (int i = 0; i <= 2000; ++i) all.push_back(std::cos(1.5707963267948966 * i / 2000));
  all.push_back(1);
  return all;
}

// The critical cosine and doubles around it, one ulp apart.
std::vector<double> aroundCritical(const Pair& p, int ulps) {
  const long double s = static_cast<long double>(p.c_1) / p.c_2;
  const double critical = static_cast<double>(std::sqrt((1 - s) * (1 + s)));
  std::vector<double> all{critical};
  for (double up = critical, down = critical; ulps-- > 0;) {
    all.push_back(up = std::nextafter(up, 2));
    all.push_back(down = std::nextafter(down, 0));
  }
  return all;
}

// Law: R + T cos_t / cos_i = 1. Not R + T = 1: the beam changes its width.
TEST(InterfaceLaw, ReflectedAndTransmittedPowerAddToOneBelowTheCriticalAngle) {
  for (const Pair& p : kPairs)
    for (const double cos_i : incidences()) {
      const auto cos_t = transmissionCosine(cos_i, p.c_1, p.c_2);
      if (!cos_t || cos_i < 1e-12) continue;
      const double R = reflectance(p.Z_1, p.Z_2, cos_i, *cos_t);
      const double T = transmittance(p.Z_1, p.Z_2, cos_i, *cos_t);
      EXPECT_NEAR(R + T * *cos_t / cos_i, 1, 1e-14) << p.Z_2 << ' ' << cos_i;
    }
}

// Law: T_12 T_21 = (1 - R)^2, on which "forward ray tracing only" rests.
TEST(InterfaceLaw, ForwardTimesBackwardTransmissionIsOneMinusRSquared) {
  for (const Pair& p : kPairs)
    for (const double cos_i : incidences()) {
      const auto cos_t = transmissionCosine(cos_i, p.c_1, p.c_2);
      if (!cos_t) continue;
      const double R = reflectance(p.Z_1, p.Z_2, cos_i, *cos_t);
      const double there = transmittance(p.Z_1, p.Z_2, cos_i, *cos_t);
      const double back = transmittance(p.Z_2, p.Z_1, *cos_t, cos_i);
      EXPECT_NEAR(there * back, (1 - R) * (1 - R), 1e-14) << p.Z_2 << ' ' << cos_i;
    }
}

// Law: R_12(theta_i) = R_21(theta_t), to the last bit, since swapping media changes only a sign.
TEST(InterfaceLaw, ReflectionIsTheSameFromBothSidesAlongTheSameRay) {
  for (const Pair& p : kPairs)
    for (const double cos_i : incidences()) {
      const auto cos_t = transmissionCosine(cos_i, p.c_1, p.c_2);
      if (!cos_t) continue;
      EXPECT_EQ(reflectance(p.Z_1, p.Z_2, cos_i, *cos_t), reflectance(p.Z_2, p.Z_1, *cos_t, cos_i));
    }
}

// An interface between equal media must vanish: splitting a structure in two may not draw a line.
TEST(InterfaceLaw, EqualMediaReflectNothingAtAnyAngle) {
  for (const double cos_i : incidences()) {
    const InterfaceLaw law = interfaceLaw(1.6e6, 1540, 1.6e6, 1540, cos_i);
    EXPECT_FALSE(law.total);
    EXPECT_LT(law.R, 1e-30) << cos_i;
  }
  EXPECT_EQ(interfaceLaw(1.6e6, 1540, 1.6e6, 1540, 0).R, 0);
}

// Z_1 = Z_2 leaves (cos_i - cos_t)^2, which is 0 straight on and grows aside.
TEST(InterfaceLaw, EqualImpedanceReflectsNothingAtNormalIncidenceAndSomethingAside) {
  EXPECT_EQ(interfaceLaw(1.5e6, 1480, 1.5e6, 1600, 1).R, 0);
  EXPECT_GT(interfaceLaw(1.5e6, 1480, 1.5e6, 1600, 0.7).R, 1e-4);
}

// R = ((Z_2 - Z_1) / (Z_2 + Z_1))^2 whatever the speeds.
TEST(InterfaceLaw, NormalIncidenceDependsOnImpedanceAlone) {
  for (const Pair& p : kPairs) {
    const double ratio = (p.Z_2 - p.Z_1) / (p.Z_2 + p.Z_1);
    EXPECT_DOUBLE_EQ(interfaceLaw(p.Z_1, p.c_1, p.Z_2, p.c_2, 1).R, ratio * ratio);
  }
}

// cos_crit^2 = 1 - (c_1 / c_2)^2: at it, and down to a tangent ray, R is exactly 1.
TEST(InterfaceLaw, BeyondTheCriticalAngleEverythingIsReflected) {
  for (const Pair& p : kPairs) {
    if (p.c_2 <= p.c_1) continue;
    const double critical = std::sqrt((1 - p.c_1 / p.c_2) * (1 + p.c_1 / p.c_2));
    for (const double part : {0.0, 1e-300, 0.5, 0.99, 0.999999}) {
      const InterfaceLaw law = interfaceLaw(p.Z_1, p.c_1, p.Z_2, p.c_2, part * critical);
      EXPECT_TRUE(law.total);
      EXPECT_EQ(law.R, 1);
      EXPECT_FALSE(transmissionCosine(part * critical, p.c_1, p.c_2));
    }
  }
}

// Into a slower medium rays bend towards the normal: no angle is critical.
TEST(InterfaceLaw, NeverTotalIntoASlowerMediumNotEvenWhenTangent) {
  for (const double cos_i : {0.0, 5e-324, 1e-17, 1e-8})
    for (const Pair& p : kPairs)
      if (p.c_2 < p.c_1) {
        EXPECT_FALSE(interfaceLaw(p.Z_1, p.c_1, p.Z_2, p.c_2, cos_i).total);
        EXPECT_NEAR(interfaceLaw(p.Z_1, p.c_1, p.Z_2, p.c_2, cos_i).R, 1, 1e-4);
      }
}

// Double precision knows cos_t^2 to a few ulps of its terms, so cos_t to that over 2 cos_t, and not
// at all below its square root; R inherits that through its slope 4 Z_1 Z_2 cos_i / (sum)^2.
double tolerance(const Pair& p, double cos_i, const Exact& e) {
  const long double r = static_cast<long double>(p.c_2) / p.c_1;
  const long double square = 8 * std::numeric_limits<double>::epsilon() * std::max(1.0L, r * r);
  const long double cosine = std::min(square / std::max(e.cos_t, 1e-30L), std::sqrt(square));
  const long double sum = p.Z_2 * static_cast<long double>(cos_i) + p.Z_1 * e.cos_t;
  const long double slope =
      sum > 0 ? 4 * p.Z_1 * static_cast<long double>(p.Z_2) * cos_i / (sum * sum) : 0;
  return static_cast<double>(1e-14L + std::min(2 * slope * cosine, 1.0L));
}

// Eq. 1 in long double is the oracle.
TEST(InterfaceLaw, AgreesWithLongDoubleOverAllAngles) {
  for (const Pair& p : kPairs)
    for (const double cos_i : incidences()) {
      const Exact e = exactly(p, cos_i);
      EXPECT_NEAR(interfaceLaw(p.Z_1, p.c_1, p.Z_2, p.c_2, cos_i).R, static_cast<double>(e.R),
                  tolerance(p, cos_i, e))
          << p.Z_2 << ' ' << cos_i;
    }
}

// There the root of cos theta_t is steepest: each step of the angle counts.
TEST(InterfaceLaw, AgreesWithLongDoubleUlpByUlpAroundTheCriticalAngle) {
  for (const Pair& p : kPairs) {
    if (p.c_2 <= p.c_1) continue;
    for (const double cos_i : aroundCritical(p, 200)) {
      const Exact e = exactly(p, cos_i);
      const InterfaceLaw law = interfaceLaw(p.Z_1, p.c_1, p.Z_2, p.c_2, cos_i);
      EXPECT_NEAR(law.R, static_cast<double>(e.R), tolerance(p, cos_i, e)) << cos_i;
      EXPECT_TRUE(law.R >= 0 && law.R <= 1);
      EXPECT_TRUE(!law.total || law.R == 1);
      const long double r = static_cast<long double>(p.c_2) / p.c_1;
      if (std::abs(e.cos_t_squared) > 4 * std::numeric_limits<double>::epsilon() * r * r) {
        EXPECT_EQ(law.total, e.cos_t_squared < 0) << cos_i;
      }
    }
  }
}

// The same law for four interfaces at once, here four of one kind.
void expectLanesAgree(const Pair& p, double cos_i) {
  const Exact e = exactly(p, cos_i);
  const auto four = [](double a) { return Doubles4{} + a; };
  const SpeedRatio speeds = speedRatio(p.c_1, p.c_2);
  const Doubles4 R =
      reflectedShares(four(p.Z_1), four(p.Z_2), four(speeds.r), four(speeds.turn), four(cos_i));
  for (std::size_t j = 0; j < kDoubleLanes; ++j) {
    EXPECT_NEAR(R[j], static_cast<double>(e.R), tolerance(p, cos_i, e)) << p.Z_2 << ' ' << cos_i;
    EXPECT_TRUE(R[j] >= 0 && R[j] <= 1);
  }
  if (p.c_1 == p.c_2) {
    EXPECT_NEAR(reflectedAtEqualSpeeds(four(p.Z_1), four(p.Z_2))[0],
                interfaceLaw(p.Z_1, p.c_1, p.Z_2, p.c_2, cos_i).R, 1e-15);
  }
}

// Lanes hold the same law as the single interface.
TEST(InterfaceLaw, OfFourInterfacesAtOnceAgreesWithLongDouble) {
  for (const Pair& p : kPairs) {
    for (const double cos_i : incidences()) expectLanesAgree(p, cos_i);
    if (p.c_2 <= p.c_1) continue;
    for (const double cos_i : aroundCritical(p, 200)) expectLanesAgree(p, cos_i);
  }
}

// Of media that differ by little R is the square of that little, not of rounding.
TEST(InterfaceLaw, OfFourInterfacesOfNearlyEqualMediaKeepsItsDigits) {
  for (const double cos_i : {0.1, 0.5, 1.0}) {
    const double Z_1 = 1.6e6, Z_2 = Z_1 * (1 + 1e-9), c_1 = 1540, c_2 = c_1 * (1 + 1e-10);
    const auto four = [](double a) { return Doubles4{} + a; };
    const SpeedRatio speeds = speedRatio(c_1, c_2);
    const double R = interfaceLaw(Z_1, c_1, Z_2, c_2, cos_i).R;
    EXPECT_NEAR(
        reflectedShares(four(Z_1), four(Z_2), four(speeds.r), four(speeds.turn), four(cos_i))[0], R,
        1e-12 * R);
  }
}

// Aside of the normal an echo is no stronger than the impedances alone make it, and a weaker one
// stays as it is.
TEST(InterfaceLaw, TheCapIsTheReflectanceOfNormalIncidence) {
  for (const Pair& p : kPairs) {
    const double normal = reflectance(p.Z_1, p.Z_2, 1, 1);
    for (const double share : {0.0, 0.5, 1.0})
      EXPECT_DOUBLE_EQ(cappedReflectance(share * normal, p.Z_1, p.Z_2), share * normal);
    EXPECT_DOUBLE_EQ(cappedReflectance(1, p.Z_1, p.Z_2), normal);
  }
}

// Section 2.1: W cos^n theta_i.
TEST(InterfaceLaw, LobeIsWAtNormalIncidenceAndFollowsItsExponent) {
  for (const double n : {0.0, 0.5, 1.0, 2.0, 7.3}) {
    EXPECT_DOUBLE_EQ(nonSpecularReturn(0.3, 1, n), 0.3);
    EXPECT_NEAR(nonSpecularReturn(0.3, 0.6, n), 0.3 * std::pow(0.6, n), 1e-16);
    EXPECT_EQ(nonSpecularReturn(0.3, 0, n), n == 0 ? 0.3 : 0);
  }
}

// The lobe is not normalised: W is the return at normal incidence for any n, so walls of all
// orientations together return W / (n + 1).
TEST(InterfaceLaw, TheMeanReturnOverOrientationsFallsWithTheExponent) {
  for (const double n : {0.0, 1.0, 2.0, 8.0}) {
    constexpr int kSteps = 200000;  // cos of uniform orientations in a hemisphere is uniform
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += nonSpecularReturn(0.3, (i + 0.5) / kSteps, n);
    EXPECT_NEAR(sum / kSteps * (n + 1) / 0.3, 1, 1e-6) << n;
  }
}

}  // namespace
}  // namespace echocine
