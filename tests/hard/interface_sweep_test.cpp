// Eqs. 1 and 2 swept across their hard points against long double: grazing and tangent rays, the
// critical angle ulp by ulp, equal and nearly equal media.

#include <gtest/gtest.h>

#include "support/sweep.h"
#include "trace/interface_law.h"

namespace echocine {
namespace {

using support::decades, support::Sweep, support::ulpsAround;

// What is left of the pulse's intensity below which an error is none: 220 dB under I_S, the square
// of a double's rounding. R is the square of a difference that double precision knows to 1e-16.
constexpr double kNothing = 1e-22;

struct Media {
  double Z_1, c_1, Z_2, c_2;
};
const Media kMuscleToBlood{1.679e6, 1584, 1.659e6, 1580},
    kBloodToMuscle{1.659e6, 1580, 1.679e6, 1584}, kFatToMuscle{1.355e6, 1462, 1.679e6, 1584},
    kTissueToLung{1.659e6, 1580, 2.6e5, 650}, kTissueToBone{1.659e6, 1580, 5.947e6, 3194},
    kEqualSpeed{1.6e6, 1540, 1.7e6, 1540}, kEqualImpedanceSlower{1.5e6, 1600, 1.5e6, 1480},
    kEqualImpedanceFaster{1.5e6, 1480, 1.5e6, 1600};
const std::vector<Media> kAll{kMuscleToBlood,        kBloodToMuscle,       kFatToMuscle,
                              kTissueToLung,         kTissueToBone,        kEqualSpeed,
                              kEqualImpedanceSlower, kEqualImpedanceFaster};

struct Exact {
  long double R = 1, through = 0;  // R and 1 - R
  bool total = true;
};

// cos_t^2 = 1 - r^2 + r^2 cos^2 with every difference of inputs taken first: 1e-19 of each term.
Exact exactly(const Media& m, long double cos_i) {
  const long double c_1 = m.c_1, c_2 = m.c_2;
  const long double square = ((c_1 - c_2) * (c_1 + c_2) + c_2 * c_2 * cos_i * cos_i) / (c_1 * c_1);
  if (square <= 0 && m.c_2 > m.c_1) return {};
  const long double a = m.Z_2 * cos_i, b = m.Z_1 * std::sqrt(std::max(square, 0.0L));
  if (!(a + b > 0)) {  // tangent between equal speeds: the ratio of normal incidence
    const long double q = (static_cast<long double>(m.Z_2) - m.Z_1) / (m.Z_2 + m.Z_1);
    return {q * q, 1 - q * q, false};
  }
  return {(a - b) / (a + b) * ((a - b) / (a + b)), 4 * a * b / ((a + b) * (a + b)), false};
}

InterfaceLaw law(const Media& m, double cos_i) {
  return interfaceLaw(m.Z_1, m.c_1, m.Z_2, m.c_2, cos_i);
}

double criticalCosine(const Media& m) {
  const long double s = static_cast<long double>(m.c_1) / m.c_2;
  return static_cast<double>(std::sqrt((1 - s) * (1 + s)));
}

// 1 - R is lost to rounding where R comes near 1, if it is taken as that difference.
TEST(InterfaceSweep, GrazingAndTangentRaysReflectWhatTheyShould) {
  Sweep reflected("grazing and tangent: R", "long double", "cos_i", 1e-5, kNothing);
  Sweep passed("grazing and tangent: (1-R)^2", "long double", "cos_i", 1e-5);
  for (const Media& m : kAll) {
    std::vector<double> cosines = decades(1e-18, 1, 1500);
    for (const double x : {0.0, 5e-324, 2.3e-308, 1e-200}) cosines.push_back(x);
    for (const double cos_i : cosines) {
      // The critical angle has a sweep of its own.
      if (m.c_2 > m.c_1 && std::abs(cos_i / criticalCosine(m) - 1) < 1e-3) continue;
      const Exact exact = exactly(m, cos_i);
      const InterfaceLaw got = law(m, cos_i);
      EXPECT_EQ(got.total, exact.total);
      reflected.add(cos_i, got.R, exact.R);
      if (cos_i > 1e-150)
        passed.add(cos_i, got.through * got.through, exact.through * exact.through);
    }
  }
}

// Where cos_t is 0 its slope is infinite: no number can be had to better than what a change of
// cos_i by some ulps does to it. So the loss must lie between those of cosines 4 ulps away.
// cos_t is a square root that ends at 0: its slope is infinite there.
TEST(InterfaceSweep, TheCriticalAngleIsPassedUlpByUlpWithoutAJump) {
  Sweep reflected("critical angle: R", "long double", "cos_i / cos_c - 1", 1e-5);
  Sweep passed("critical angle: (1-R)^2 within 4 ulps of the angle", "long double",
               "cos_i / cos_c - 1", 1e-5);
  for (const Media& m : kAll) {
    if (m.c_2 <= m.c_1) continue;
    const double critical = criticalCosine(m);
    std::vector<double> cosines = ulpsAround(critical, 500);
    for (const double away : decades(1e-16, 1e-2, 500)) {
      cosines.push_back(critical * (1 + away));
      cosines.push_back(critical * (1 - away));
    }
    for (const double cos_i : cosines) {
      const InterfaceLaw got = law(m, cos_i);
      reflected.add(cos_i / critical - 1, got.R, exactly(m, cos_i).R);
      const double ulps = 4 * (std::nextafter(cos_i, 2) - cos_i);
      const long double low = exactly(m, cos_i - ulps).through,
                        high = exactly(m, cos_i + ulps).through;
      EXPECT_TRUE(!got.total || (got.R == 1 && got.through == 0));
      const auto loss = static_cast<long double>(got.through) * got.through;
      passed.add(cos_i / critical - 1, loss, std::clamp(loss, low * low, high * high));
    }
  }
}

// To one side there is a transmitted ray, to the other there is none, and R joins without a jump.
TEST(InterfaceSweep, OneUlpDecidesTotalReflectionOnlyAtTheCriticalAngle) {
  for (const Media& m : kAll)
    for (const double part : {0.5, 0.9, 0.999999, 1.000001, 1.1}) {
      if (m.c_2 <= m.c_1) continue;
      for (const double cos_i : ulpsAround(part * criticalCosine(m), 4))
        EXPECT_EQ(law(m, cos_i).total, part < 1) << cos_i;
    }
}

// From media that differ in the last bit to a thousandfold, the other quantity equal or not.
void sweepContrast(const char* name, Media (*media)(double), bool sign_up) {
  Sweep reflected(std::string(name) + ": R", "long double", "contrast", 1e-5, kNothing);
  Sweep passed(std::string(name) + ": (1-R)^2", "long double", "contrast", 1e-5);
  for (const double cos_i : {1.0, 0.9999, 0.8, 0.5, 0.1, 1e-3})
    for (const double contrast : decades(1e-16, 1e3, 1000)) {
      const Media m = media(sign_up ? 1 + contrast : 1 / (1 + contrast));
      const Exact exact = exactly(m, cos_i);
      if (exact.total || (m.c_2 > m.c_1 && std::abs(cos_i / criticalCosine(m) - 1) < 1e-3))
        continue;
      const InterfaceLaw got = law(m, cos_i);
      reflected.add(contrast, got.R, exact.R);
      passed.add(contrast, got.through * got.through, exact.through * exact.through);
    }
}

TEST(InterfaceSweep, EqualImpedanceAndAnyRatioOfSpeeds) {
  const auto media = [](double ratio) { return Media{1.6e6, 1540, 1.6e6, 1540 * ratio}; };
  sweepContrast("equal Z, faster", media, true);
  sweepContrast("equal Z, slower", media, false);
}

TEST(InterfaceSweep, EqualSpeedAndAnyRatioOfImpedances) {
  const auto media = [](double ratio) { return Media{1.6e6, 1540, 1.6e6 * ratio, 1540}; };
  sweepContrast("equal c, denser", media, true);
  sweepContrast("equal c, lighter", media, false);
}

// From media equal to the last digits to absurdly unlike ones.
TEST(InterfaceSweep, AnyContrastOfBoth) {
  const auto media = [](double ratio) {
    return Media{1.6e6, 1540, 1.6e6 * ratio, 1540 * std::sqrt(ratio)};
  };
  sweepContrast("contrast of Z and c, up", media, true);
  sweepContrast("contrast of Z and c, down", media, false);
}

TEST(InterfaceSweep, EqualMediaReflectNothingAndBendNothingAtAnyAngle) {
  Sweep reflected("equal media: R and bend", "0", "cos_i", 0);
  for (const double cos_i : decades(1e-18, 1, 3000)) {
    const Vec3d direction{std::sqrt((1 - cos_i) * (1 + cos_i)), 0, cos_i};
    const auto bent = refracted(direction, {0, 0, -1}, 1540, 1540);
    ASSERT_TRUE(bent);
    const double moved = *bent == direction ? 0 : 1;
    // R of the formula; the walk does not even ask it (sameInterface).
    const double R = interfaceLaw(1.6e6, 1540, 1.6e6, 1540, cos_i).R;
    reflected.addError(cos_i, moved + (R < 1e-30 ? 0 : R));
  }
}

// The bent direction: its sine is Snell's, also grazing and next to the critical angle.
TEST(InterfaceSweep, BentDirectionsAreSnells) {
  Sweep bent("refracted direction, rad", "long double", "cos_i", 1e-7);
  for (const Media& m : kAll) {
    std::vector<double> cosines = decades(1e-15, 1, 1000);
    if (m.c_2 > m.c_1)
      for (const double x : ulpsAround(criticalCosine(m), 100)) cosines.push_back(x);
    for (const double cos_i : cosines) {
      const double sin_i = std::sqrt((1 - cos_i) * (1 + cos_i));
      const auto got = refracted({sin_i, 0, cos_i}, {0, 0, -1}, m.c_1, m.c_2);
      if (!got) continue;
      const long double r = static_cast<long double>(m.c_2) / m.c_1;
      const long double sin_t = std::min(r * sin_i, 1.0L);
      const long double cos_t = std::sqrt((1 - sin_t) * (1 + sin_t));
      // The angle between both: of the cross product, which has no square root to lose digits in.
      const auto error = static_cast<double>(std::abs(got->x * cos_t - got->z * sin_t));
      bent.addError(cos_i, std::abs(length(*got) - 1) > 1e-14 ? 1 : error);
    }
  }
}

}  // namespace
}  // namespace echocine
