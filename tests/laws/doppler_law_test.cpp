// Velocities by autocorrelation against closed forms: a plate, a disc and a shell of scatterers.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/hash_random.h"
#include "core/parallel.h"
#include "doppler/autocorrelation.h"
#include "scene/scan_geometry.h"
#include "support/measured.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kDopplerLines = 41, kDopplerSamples = 200;
constexpr double kDopplerPrf_hz = 1000;

SpeckleBed dopplerBed(int seed = 1) {
  SpeckleBed bed(ProbeKind::phased, kDopplerLines, kDopplerSamples, 0.06, 0.06 + 200 * 0.2e-3);
  bed.settings.seed = seed;
  return bed;
}

// Fields of the pulses of a packet, centred on time 0; `at` gives the tissue at a time.
std::vector<PulseField> packet(const SpeckleBed& bed, const Speckle& speckle, int pulses,
                               const std::function<Affine(double)>& at) {
  std::vector<PulseField> fields;
  for (int n = 0; n < pulses; ++n) {
    std::vector<float> intensities = bed.even();
    EchoField field;
    field.resize(bed.size());
    const double time_s = (n - 0.5 * (pulses - 1)) / kDopplerPrf_hz;
    speckle.apply(at(time_s), time_s, intensities, {}, {0, bed.probe.lines}, &field);
    fields.push_back({field.real, field.imaginary});
  }
  return fields;
}

VelocityPlanes estimated(const SpeckleBed& bed, const std::vector<PulseField>& pulses,
                         WallFilterKind wall = WallFilterKind::none, double gate_m = 1e-3) {
  VelocityPlanes planes;
  withThreads(1, [&] {
    planes = estimateVelocity(pulses, WallFilter(wall, static_cast<int>(pulses.size())), bed.probe,
                              kDopplerPrf_hz, gate_m);
  });
  return planes;
}

// Power-weighted mean and RMS of the wrapped difference from a closed form, over v_N.
struct Off {
  double bias = 0, rms = 0;
};
Off offFrom(const SpeckleBed& bed, const VelocityPlanes& planes,
            const std::function<double(Vec3d place, Vec3d direction)>& exact) {
  const double nyquist = nyquistVelocity(bed.probe, kDopplerPrf_hz);
  const ScanGeometry geometry(bed.probe);
  double weight = 0, sum = 0, squares = 0;
  for (int i = 3; i < bed.probe.lines - 3; ++i) {
    const LineGeometry line = lineGeometry(bed.probe, i);
    for (int k = 8; k < bed.probe.samples - 8; ++k) {
      const auto at = static_cast<std::size_t>(i * bed.probe.samples + k);
      const Vec3d place = line.origin + geometry.sampleDepth(k) * line.direction;
      const auto v = static_cast<double>(planes.velocity_m_s[at]);
      const auto power = static_cast<double>(planes.power[at]);
      const double off = std::remainder(v - exact(place, line.direction), 2 * nyquist) / nyquist;
      weight += power;
      sum += power * off;
      squares += power * off * off;
    }
  }
  return {sum / weight, std::sqrt(squares / weight)};
}

// A plate that moves with a velocity of parts of v_N, across the wrap too.
TEST(DopplerLaw, AMovingPlateHasItsVelocity) {
  const SpeckleBed bed = dopplerBed();
  const Speckle speckle = bed.speckle();
  const double nyquist = nyquistVelocity(bed.probe, kDopplerPrf_hz);
  EXPECT_NEAR(nyquist, 1540 / 2.5e6 * kDopplerPrf_hz / 4, 1e-12);
  Largest bias("bias over v_N", ""), rms("RMS over v_N", "");
  for (const double of_nyquist : {0.0, 0.05, -0.3, 0.6, 0.95, -0.95, 1.2, -1.7}) {
    const double away = -of_nyquist * nyquist;  // along z
    const Off off = offFrom(bed,
                            estimated(bed, packet(bed, speckle, 4,
                                                  [&](double t) {
                                                    return shifted({0, 0, away * t});
                                                  })),
                            [&](Vec3d, Vec3d direction) { return -away * direction.z; });
    EXPECT_LT(std::abs(bias(off.bias)), 0.01) << of_nyquist;
    // Speckle decorrelates with the motion from pulse to pulse.
    EXPECT_LT(rms(off.rms), 0.02 + 0.08 * std::abs(of_nyquist)) << of_nyquist;
  }
}

// Faster than v_N the shown velocity lies 2 v_N lower.
TEST(DopplerLaw, AliasingIsWhereItMustBe) {
  const SpeckleBed bed = dopplerBed();
  const Speckle speckle = bed.speckle();
  const double nyquist = nyquistVelocity(bed.probe, kDopplerPrf_hz);
  const auto shown = [&](double velocity) {
    const VelocityPlanes planes = estimated(bed, packet(bed, speckle, 4, [&](double t) {
                                              return shifted({0, 0, -velocity * t});
                                            }));
    double sum = 0;
    constexpr int kMiddle = kDopplerLines / 2;
    for (int k = 20; k < kDopplerSamples - 20; ++k)
      sum += static_cast<double>(
          planes.velocity_m_s[static_cast<std::size_t>(kMiddle * kDopplerSamples + k)]);
    return sum / (kDopplerSamples - 40);
  };
  EXPECT_NEAR(shown(0.8 * nyquist), 0.8 * nyquist, 0.02 * nyquist);
  EXPECT_NEAR(shown(1.2 * nyquist), -0.8 * nyquist, 0.02 * nyquist);
  EXPECT_NEAR(shown(-1.2 * nyquist), 0.8 * nyquist, 0.02 * nyquist);
  EXPECT_NEAR(shown(2.3 * nyquist), 0.3 * nyquist, 0.03 * nyquist);
}

// A disc that turns about the middle of the sector: v = -omega x r . line.
TEST(DopplerLaw, ATurningDiscHasTheVelocityOfEachPlace) {
  Largest bias("bias over v_N", ""), rms("RMS over v_N", "");
  for (const double turns_s : {0.5, -1.5}) {
    const double omega = 2 * std::numbers::pi * turns_s;
    const Vec3d centre{0.0, 0, 0.08};
    const SpeckleBed bed = dopplerBed(3);
    const Speckle speckle = bed.speckle();
    const auto at = [&](double t) {
      Affine map = turned(omega * t);
      const Vec3d moved = centre.x * map.x + centre.y * map.y + centre.z * map.z;
      map.shift = centre - moved;
      return map;
    };
    const Off off = offFrom(bed, estimated(bed, packet(bed, speckle, 4, at)),
                            [&](Vec3d place, Vec3d direction) {
                              const Vec3d from = place - centre;
                              const Vec3d velocity{omega * from.z, 0, -omega * from.x};
                              return -dot(velocity, direction);
                            });
    EXPECT_LT(std::abs(bias(off.bias)), 0.01) << turns_s;
    EXPECT_LT(rms(off.rms), 0.08) << turns_s;
  }
}

// A shell that contracts towards its middle, the same in all directions: v = rate (x - middle).
TEST(DopplerLaw, AContractingShellHasTheVelocityOfEachPlace) {
  Largest bias("bias over v_N", ""), rms("RMS over v_N", "");
  for (const double rate_s : {-3.0, 4.0}) {
    const Vec3d middle{0.004, 0, 0.075};
    const SpeckleBed bed = dopplerBed(5);
    const Speckle speckle = bed.speckle();
    const auto at = [&](double t) {
      Affine map;
      const double factor = 1 + rate_s * t;
      map.x = {factor, 0, 0};
      map.y = {0, factor, 0};
      map.z = {0, 0, factor};
      map.shift = (1 - factor) * middle;
      return map;
    };
    const Off off = offFrom(
        bed, estimated(bed, packet(bed, speckle, 4, at)),
        [&](Vec3d place, Vec3d direction) { return -dot(rate_s * (place - middle), direction); });
    EXPECT_LT(std::abs(bias(off.bias)), 0.02) << rate_s;
    EXPECT_LT(rms(off.rms), 0.1) << rate_s;
  }
}

// More pulses reduce the spread of the estimate, noise raises it, and the variance tells of it.
TEST(DopplerLaw, TheSpreadFallsWithPulsesAndVarianceTellsOfNoise) {
  const SpeckleBed bed = dopplerBed();
  const Speckle speckle = bed.speckle();
  std::vector<double> spread, variance;
  for (const int pulses : {2, 4, 16}) {
    std::vector<PulseField> fields = packet(bed, speckle, pulses, [&](double t) {
      return shifted({0, 0, -0.03 * t});
    });
    std::uint64_t number = 0;
    for (PulseField& field : fields)
      for (std::size_t i = 0; i < field.real.size(); ++i) {
        const auto drawn = [&] {
          ++number;
          return static_cast<float>(0.3 * std::sqrt(0.5) *
                                    normalFromHashes(hashOf(7, number), hashOf(8, number)));
        };
        field.real[i] += drawn();
        field.imaginary[i] += drawn();
      }
    const VelocityPlanes planes = estimated(bed, fields, WallFilterKind::none, 0);
    spread.push_back(offFrom(bed, planes, [](Vec3d, Vec3d d) { return 0.03 * d.z; }).rms);
    double sum = 0;
    for (const float v : planes.variance_m2_s2) sum += static_cast<double>(v);
    variance.push_back(sum / static_cast<double>(planes.variance_m2_s2.size()));
  }
  std::printf("[ MEASURED ] RMS over v_N with 2, 4, 16 pulses: %.4f %.4f %.4f\n", spread[0],
              spread[1], spread[2]);
  EXPECT_LT(spread[1], 0.8 * spread[0]);
  EXPECT_LT(spread[2], 0.6 * spread[1]);
  const VelocityPlanes clean = estimated(bed, packet(bed, speckle, 16, [&](double t) {
                                           return shifted({0, 0, -0.03 * t});
                                         }));
  double sum = 0;
  for (const float v : clean.variance_m2_s2) sum += static_cast<double>(v);
  EXPECT_LT(sum / static_cast<double>(clean.variance_m2_s2.size()), 0.3 * variance[2]);
}

// (D4): what stands still, or grows as the polynomial, vanishes; a fast turn passes.
TEST(DopplerLaw, TheWallFilterRemovesItsPolynomialAlone) {
  constexpr int kPulses = 9;
  for (const auto& kind : NamesOf<WallFilterKind>::kAll) {
    const int order = static_cast<int>(kind.value);
    const WallFilter filter(kind.value, kPulses);
    for (int power = 0; power <= 3; ++power) {
      std::vector<double> packet;
      for (int n = 0; n < kPulses; ++n) packet.push_back(std::pow(0.4 * n - 1, power));
      filter.apply(packet);
      double squares = 0;
      for (const double z : packet) squares += z * z;
      EXPECT_EQ(squares < 1e-20, power < order) << kind.name << " " << power;
    }
    std::vector<double> fast;
    for (int n = 0; n < kPulses; ++n) fast.push_back(n % 2 == 0 ? 1 : -1);
    filter.apply(fast);
    double squares = 0;
    for (const double z : fast) squares += z * z;
    EXPECT_GT(squares, 0.85 * kPulses) << kind.name;
  }
}

// A wall in front of moving tissue hides it, until the filter removes the wall.
TEST(DopplerLaw, TheWallFilterShowsTissueBehindStillEchoes) {
  const SpeckleBed bed = dopplerBed(), wall_bed = dopplerBed(17);
  const Speckle speckle = bed.speckle(), wall = wall_bed.speckle();
  const double nyquist = nyquistVelocity(bed.probe, kDopplerPrf_hz);
  std::vector<PulseField> fields = packet(bed, speckle, 8, [&](double t) {
    return shifted({0, 0, -0.6 * nyquist * t});
  });
  const PulseField still = packet(wall_bed, wall, 1, [](double) {
                             return shifted({0, 0, 0});
                           }).front();
  for (PulseField& field : fields)
    for (std::size_t i = 0; i < field.real.size(); ++i) {
      field.real[i] += 3 * still.real[i];
      field.imaginary[i] += 3 * still.imaginary[i];
    }
  const auto exact = [&](Vec3d, Vec3d d) { return 0.6 * nyquist * d.z; };
  EXPECT_LT(offFrom(bed, estimated(bed, fields), exact).bias, -0.4);
  EXPECT_LT(std::abs(offFrom(bed, estimated(bed, fields, WallFilterKind::mean), exact).bias), 0.05);
}

// The field against the plain sum of README (1): phases and envelope of every scatterer.
TEST(DopplerLaw, PhasesTurnByTwoPiPerHalfWavelengthOfMotion) {
  const SpeckleBed bed = dopplerBed();
  const Speckle speckle = bed.speckle();
  const double half_wave_m = 0.5 * ScanGeometry(bed.probe).wavelength();
  Largest off("phase off by", "turns");
  for (const double part : {0.01, 0.125, 0.37, 0.5}) {
    const double shift_m = part * half_wave_m;
    const auto fields = packet(bed, speckle, 2, [&](double t) {
      return shifted({0, 0, shift_m * t * kDopplerPrf_hz});
    });
    const VelocityPlanes planes = estimated(bed, fields);
    double sum = 0;
    constexpr int kMiddle = kDopplerLines / 2;
    for (int k = 20; k < kDopplerSamples - 20; ++k)
      sum += std::remainder(
          static_cast<double>(
              planes.velocity_m_s[static_cast<std::size_t>(kMiddle * kDopplerSamples + k)]) /
                  nyquistVelocity(bed.probe, kDopplerPrf_hz) / 2 +
              part,
          1.0);
    EXPECT_LT(std::abs(off(sum / (kDopplerSamples - 40))), 0.004) << part;
  }
}

}  // namespace
}  // namespace echocine
