// Stacks of thin layers against an exact solution of our own: at any angle, beyond critical ones
// too, from a tenth of a micrometre to half a millimetre, and without steps on the way to thick.

#include <gtest/gtest.h>

#include <complex>
#include <numbers>

#include "support/measured.h"
#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;
using Real = long double;
using Complex = std::complex<Real>;

constexpr double kFrequency = 2.5e6;
constexpr Real kPi = std::numbers::pi_v<Real>;

struct Shares {
  Real back = 0, behind = 0;  // of the pulse's energy; behind: forward and back
};

// A plane wave on layers by their input impedance, from the last to the first: in each layer with
// the impedance z = Z / cos theta and the phase p = 2 pi f h cos theta / c,
//   z_in = z (z_behind - i z tan p) / (z - i z_behind tan p).
// Nothing is lost, so what does not come back goes through, unless the last medium carries no wave.
Shares exactAt(Real f_hz, const std::vector<Medium>& media, const std::vector<double>& thickness_m,
               Real sine) {
  const auto cosine = [&](const Medium& m) {
    const Real s = sine * m.sound_speed_m_s / media.front().sound_speed_m_s;
    return std::sqrt(Complex(1 - s * s, 0));  // +i beyond the critical angle
  };
  const auto impedance = [&](const Medium& m) { return Real(m.impedance_kg_m2_s) / cosine(m); };
  Complex z_in = impedance(media.back());
  const Complex i(0, 1);
  for (std::size_t l = media.size() - 2; l > 0; --l) {
    const Complex z = impedance(media[l]);
    const Complex turn = std::tan(2 * kPi * f_hz * Real(thickness_m[l - 1]) * cosine(media[l]) /
                                  Real(media[l].sound_speed_m_s));
    z_in = z * (z_in - i * z * turn) / (z - i * z_in * turn);
  }
  const Complex z_0 = impedance(media.front());
  const Real back = std::norm((z_in - z_0) / (z_in + z_0));
  const bool carries = cosine(media.back()).real() > 0;
  return {back, carries ? (1 - back) * (1 - back) : 0};
}

// Averaged over the spectrum of a gated sine of two cycles, in units of its frequency: by f up to
// 3, by 1 / f beyond.
Shares exact(const std::vector<Medium>& media, const std::vector<double>& thickness_m,
             double degrees) {
  const Real sine = std::sin(degrees * kPi / 180);
  Shares sum;
  Real energy = 0;
  const auto add = [&](Real f, Real width) {
    const Real wave = std::sin(2 * kPi * f) / (f * f - 1), weight = wave * wave * width;
    const Shares at = exactAt(f * kFrequency, media, thickness_m, sine);
    sum.back += weight * at.back;
    sum.behind += weight * at.behind;
    energy += weight;
  };
  constexpr int kSteps = 6000, kBeyond = 3000;
  for (int k = 0; k < kSteps; ++k) add(3 * (k + 0.5L) / kSteps, 3.0L / kSteps);
  for (int k = 0; k < kBeyond; ++k) {
    const Real u = (k + 0.5L) / (3 * kBeyond);
    add(1 / u, 1 / (3 * kBeyond * u * u));
  }
  return {sum.back / energy, sum.behind / energy};
}

// A scene of a background and nested boxes, the walls of which a line meets at one angle.
Scene stackScene(const std::vector<Medium>& media) {
  Scene scene = plainScene(media);
  for (Medium& m : scene.media) m.backscatter_per_m_sr = 1e-3;
  scene.probe.max_depth_m = 10;
  for (std::size_t m = 1; m + 1 < media.size(); ++m) {
    addStructure(scene, m, 1);
    scene.structures.back().reflection_exponent = 0;
  }
  return scene;
}

// What the walk gets back from layers that stand one on the other, and from behind them.
Shares walked(const Scene& scene, const std::vector<double>& thickness_m, double degrees) {
  TraceSettings settings = straightSettings(scene);
  settings.reflection_cap = false;  // the exact layer is a mirror
  const double cos_i = std::cos(radiansFromDegrees(degrees));
  std::vector<Crossing> crossings;
  double path_m = 0.05;
  for (std::uint32_t l = 0; l < thickness_m.size(); ++l) {
    Crossing in = crossingAt(path_m, l, true, cos_i);
    crossings.push_back(in);
    path_m += thickness_m[l] / cos_i;
    in.distance_m = path_m;
    in.normal = -in.normal;
    in.entering = false;
    crossings.push_back(in);
  }
  const LineTrace line = walkStraight(settings, crossings);
  Shares shares;
  for (const Echo& echo : line.echoes) shares.back += Real(echo.intensity);
  if (line.segments.back().end_depth_m >= settings.max_depth_m)
    shares.behind = line.segments.back().strength_m2_sr / (1e-3 * settings.unit_volume_m3);
  return shares;
}

double decibels(Real a, Real b) {
  return static_cast<double>(10 * std::log10(a / b));
}

const Medium kTissue = medium("tissue", 1060, 1584), kFat = medium("fat", 927, 1462);
const Medium kBone = medium("bone", 1862, 3194), kLung = medium("lung", 400, 650),
             kMuscle = medium("muscle", 1065, 1600), kValve = medium("valve", 1120, 1584);
const std::vector<double> kMicrometres{0.1, 0.5, 1, 3, 10, 30, 60, 100, 150, 200, 300, 400, 500};
const std::vector<double> kDegrees{0, 15, 27, 29.7, 30, 35, 50, 60, 70, 80, 85};

struct LayerMiss {
  support::Largest echo{"echo", "dB"}, behind{"behind", "dB"};
};

void expectExact(const std::vector<Medium>& media, const std::vector<double>& thickness_m,
                 double degrees, const std::string& what, LayerMiss& miss) {
  const Shares wanted = exact(media, thickness_m, degrees),
               found = walked(stackScene(media), thickness_m, degrees);
  if (wanted.back > 1e-9L) {
    EXPECT_NEAR(miss.echo(decibels(found.back, wanted.back)), 0, 0.3) << "echo of " << what;
  }
  if (wanted.behind > 1e-9L) {
    EXPECT_NEAR(miss.behind(decibels(found.behind, wanted.behind)), 0, 0.3) << "behind " << what;
  }
}

TEST(LayerStack, OneLayerIsTheExactOneAtEveryAngle) {
  LayerMiss miss;
  for (const Medium& around : {kTissue, kFat})
    for (const Medium& layer : {kBone, kLung, kFat, kMuscle, kValve}) {
      if (layer.name == around.name) continue;
      for (const double um : kMicrometres)
        for (const double degrees : kDegrees)
          expectExact({around, layer, around}, {um * 1e-6}, degrees,
                      std::to_string(um) + " um of " + layer.name + " in " + around.name + " at " +
                          std::to_string(degrees),
                      miss);
    }
}

TEST(LayerStack, ThreeLayersAreTheExactOnesAtEveryAngle) {
  LayerMiss miss;
  const std::vector<std::vector<Medium>> stacks{{kTissue, kFat, kMuscle, kFat, kTissue},
                                                {kTissue, kValve, kBone, kValve, kTissue},
                                                {kTissue, kBone, kFat, kBone, kTissue},
                                                {kFat, kMuscle, kValve, kBone, kFat},
                                                {kTissue, kMuscle, kLung, kMuscle, kTissue}};
  const std::vector<std::vector<double>> um{{1, 1, 1},       {0.3, 10, 3},  {30, 5, 80},
                                            {100, 100, 100}, {200, 2, 150}, {130, 170, 190}};
  for (const std::vector<Medium>& media : stacks)
    for (const std::vector<double>& thickness_um : um)
      for (const double degrees : kDegrees) {
        std::string what = std::to_string(degrees) + " degrees:";
        std::vector<double> thickness_m;
        for (std::size_t l = 0; l < 3; ++l) {
          thickness_m.push_back(thickness_um[l] * 1e-6);
          what += ' ' + std::to_string(thickness_um[l]) + " um " + media[l + 1].name;
        }
        expectExact(media, thickness_m, degrees, what, miss);
      }
}

// From layers to walls apart, in steps of a micrometre: none over 0.2 dB but where the exact
// layer's resonance is steeper than that, as of lung at a sixth of a millimetre.
TEST(LayerStack, NoMicrometreStepsByOverAFifthOfADecibel) {
  for (const Medium& layer : {kBone, kLung, kFat, kMuscle, kValve}) {
    const std::vector<Medium> media{kTissue, layer, kTissue};
    const Scene scene = stackScene(media);
    for (const double degrees : {0.0, 20.0, 45.0, 60.0, 75.0, 85.0}) {
      Shares last = walked(scene, {100e-6}, degrees);
      for (int um = 101; um < 4000; ++um) {
        const Shares now = walked(scene, {um * 1e-6}, degrees);
        const double back = decibels(now.back, last.back);
        const double behind = last.behind > 1e-4L ? decibels(now.behind, last.behind) : 0;
        last = now;
        if (std::abs(back) < 0.2 && std::abs(behind) < 0.2) continue;
        ASSERT_LT(um, 500) << layer.name << ' ' << degrees << ": " << back << ", " << behind;
        const Shares before = exact(media, {(um - 1) * 1e-6}, degrees),
                     after = exact(media, {um * 1e-6}, degrees);
        EXPECT_NEAR(back, decibels(after.back, before.back), 0.05) << layer.name << ' ' << um;
        EXPECT_NEAR(behind, decibels(after.behind, before.behind), 0.05) << layer.name << ' ' << um;
      }
    }
  }
}

TEST(LayerStack, FarFromThinItIsTheRayRule) {
  for (const Medium& layer : {kBone, kLung, kFat, kMuscle, kValve})
    for (const double degrees : {0.0, 20.0}) {
      const Scene scene = stackScene({kTissue, layer, kTissue});
      const Shares found = walked(scene, {0.025}, degrees);
      const double R =
          interfaceLaw(kTissue.impedance_kg_m2_s, kTissue.sound_speed_m_s, layer.impedance_kg_m2_s,
                       layer.sound_speed_m_s, std::cos(radiansFromDegrees(degrees)))
              .R;
      EXPECT_NEAR(static_cast<double>(found.back) / (R + (1 - R) * (1 - R) * R), 1, 1e-9);
      EXPECT_NEAR(static_cast<double>(found.behind) / std::pow(1 - R, 4), 1, 1e-9);
    }
}

TEST(LayerStack, MakesNoEnergy) {
  for (const Medium& layer : {kBone, kLung, kFat, kMuscle, kValve})
    for (const Medium& other : {kBone, kFat, kLung}) {
      const Scene scene = stackScene({kTissue, layer, other, layer, kTissue});
      for (const double um : kMicrometres)
        for (double degrees = 0; degrees < 90; degrees += 3) {
          const Shares found = walked(scene, {um * 1e-6, 1e-5, um * 3e-6}, degrees);
          EXPECT_LE(found.back, 1 + 1e-12L) << layer.name << ' ' << um << ' ' << degrees;
          EXPECT_LE(found.behind, 1 + 1e-12L) << layer.name << ' ' << um << ' ' << degrees;
        }
    }
}

// Beyond reach of its evanescent wave a fast layer is a mirror, and the line ends on it.
TEST(LayerStack, AThickFastLayerEndsTheLine) {
  const Scene scene = stackScene({kTissue, kBone, kTissue});
  const Shares found = walked(scene, {0.03}, 45);
  EXPECT_EQ(static_cast<double>(found.back), 1);
  EXPECT_EQ(static_cast<double>(found.behind), 0);
}

}  // namespace
}  // namespace echocine
