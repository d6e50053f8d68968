// Eqs. 5-7 swept across the points where their terms cancel or vanish, against long double.

#include <gtest/gtest.h>

#include <numbers>

#include "scene/backscatter_law.h"
#include "support/sweep.h"

namespace echocine {
namespace {

using support::decades, support::Sweep, support::ulpsAround;

constexpr long double kPiHere = std::numbers::pi_v<long double>;

// The bracket of Eq. 7 as an integral that nothing cancels in: each of its two pairs of terms is
// arctan(y) - y/(1+y^2) = integral of 2 t^2/(1+t^2)^2 from 0 to y, taken by Gauss-Legendre rules of
// five points over steps that grow with t.
long double arctanLess(long double y) {
  constexpr long double kNodes[] = {0.0L, 0.538469310105683091036314420700L,
                                    0.906179845938663992797626878299L};
  constexpr long double kWeights[] = {0.568888888888888888888888888889L,
                                      0.478628670499366468041291514836L,
                                      0.236926885056189087514264040720L};
  const auto f = [](long double t) { return 2 * t * t / ((1 + t * t) * (1 + t * t)); };
  long double sum = 0, begin = 0;
  const long double top = std::log1p(y);
  constexpr int kSteps = 400;
  for (int i = 1; i <= kSteps; ++i) {
    const long double end = std::expm1(top * i / kSteps), h = (end - begin) / 2,
                      m = (end + begin) / 2;
    for (int n = 0; n < 3; ++n)
      for (const int side : {-1, 1})
        if (n > 0 || side > 0) sum += kWeights[n] * h * f(m + side * h * kNodes[n]);
    begin = end;
  }
  return sum;
}

long double arctanTissue(long double mu, long double k, long double b_m) {
  const long double x = k * b_m;
  return 3 * mu * mu * k / (4 * kPiHere) * (arctanLess(x) + arctanLess(3 * x) / 9);
}

TEST(ScatteringSweep, TissueFromVanishingToHugeCorrelationLengths) {
  Sweep sweep("Eq. 7, k b_m from 1e-9 to 1e6", "long double integral without cancellation", "k b_m",
              1e-11);
  std::vector<double> all = decades(1e-9, 1e6, 3000);
  for (const double x : ulpsAround(0.05, 50)) all.push_back(x);  // where series and formula meet
  for (const double x : all)
    sweep.add(x, tissueBackscatter(0.004, 1, x), arctanTissue(0.004L, 1, x));
}

// For k b_m -> 0 the bracket is (8/3) (k b_m)^3: the leading term is the second oracle.
TEST(ScatteringSweep, TissueTendsToTheCubeOfTheCorrelationLength) {
  Sweep sweep("Eq. 7, k b_m -> 0: (8/3) (k b_m)^3", "leading term", "k b_m", 1e-8);
  for (const double x : decades(1e-90, 1e-5, 500)) {
    const long double cube = static_cast<long double>(x) * x * x;
    sweep.add(x, tissueBackscatter(1, 1, x), 3 / (4 * kPiHere) * 8 / 3 * cube);
  }
}

TEST(ScatteringSweep, BloodFromNoCellsToNothingElse) {
  Sweep sweep("Eq. 6, hematocrit 0 to 1", "long double", "hematocrit", 1e-12);
  std::vector<double> all = decades(1e-300, 1, 2000);
  for (const double x : ulpsAround(1, 1)) all.push_back(std::min(x, 1.0));
  for (const double x : decades(1e-16, 0.5, 500)) all.push_back(1 - x);
  all.push_back(0);
  for (const double W : all) {
    const long double free = (1 - static_cast<long double>(W)),
                      crowd = 1 + 2 * static_cast<long double>(W);
    sweep.add(W, bloodBackscatter(1, W, 1), W * free * free * free * free / (crowd * crowd));
  }
}

// Contrasts that are differences of nearly equal numbers.
TEST(ScatteringSweep, AParticleThatComesNearItsFluid) {
  Sweep sweep("Eq. 5, particle nearly its fluid", "long double", "contrast", 1e-5);
  for (const double part : decades(1e-10, 10, 1000)) {
    const double G = 4.1e-10, rho = 1021, G_e = G * (1 - part / 11), rho_e = rho * (1 + part / 5);
    const long double contrast =
        (static_cast<long double>(G_e) - G) / G -
        3 * (static_cast<long double>(rho_e) - rho) / (2 * static_cast<long double>(rho_e) + rho);
    const double k = 1e4, a = 2.75e-6;
    const long double cubed = static_cast<long double>(a) * a * a,
                      k2 = static_cast<long double>(k) * k;
    sweep.add(part, particleBackscatter(k, a, G_e, G, rho_e, rho),
              k2 * k2 * cubed * cubed / 9 * contrast * contrast);
  }
  EXPECT_EQ(particleBackscatter(1e4, 2.75e-6, 4.1e-10, 4.1e-10, 1021, 1021), 0);
}

}  // namespace
}  // namespace echocine
