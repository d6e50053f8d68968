// Bias and standard deviation of the velocity against pulses, PRF and gate, beside the closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>
#include <numbers>

#include "core/hash_random.h"
#include "core/parallel.h"
#include "doppler/autocorrelation.h"
#include "scene/scan_geometry.h"
#include "speckle/point_spread.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kPrecisionLines = 41, kPrecisionSamples = 400, kMostPrecisionPulses = 16, kBeds = 8;
constexpr double kPlateVelocity_m_s = 0.03, kNoiseShare = 0.01;  // 20 dB below the mean echo

// Pulses of a plate that moves away along z, with white noise; one bed of scatterers per seed.
std::vector<PulseField> noisyPulses(int seed, double prf_hz, Probe& probe) {
  SpeckleBed bed(ProbeKind::phased, kPrecisionLines, kPrecisionSamples, 0.05,
                 0.05 + kPrecisionSamples * 0.1e-3);
  bed.settings.seed = seed;
  probe = bed.probe;
  const Speckle speckle = bed.speckle();
  std::vector<PulseField> pulses;
  double power = 0;
  for (int n = 0; n < kMostPrecisionPulses; ++n) {
    std::vector<float> intensities = bed.even();
    EchoField field;
    field.resize(bed.size());
    const double time_s = n / prf_hz;
    speckle.apply(shifted({0, 0, kPlateVelocity_m_s * time_s}), time_s, intensities, {},
                  {0, bed.probe.lines}, &field);
    for (std::size_t i = 0; i < bed.size(); ++i)
      power += std::norm(std::complex<double>(field.real[i], field.imaginary[i]));
    pulses.push_back({field.real, field.imaginary});
  }
  power /= static_cast<double>(pulses.size() * bed.size());
  std::uint64_t number = 0;
  for (PulseField& pulse : pulses)
    for (std::vector<float>* part : {&pulse.real, &pulse.imaginary})
      for (float& value : *part) {
        ++number;
        value +=
            static_cast<float>(std::sqrt(0.5 * kNoiseShare * power) *
                               normalFromHashes(hashOf(seed, number, 1), hashOf(seed, number, 2)));
      }
  return pulses;
}

// README (D6): noise of the first and the last pulse, and speckle that changes as it moves.
double closedDeviation(const Probe& probe, int pulses, double prf_hz, int gate) {
  const PointSpread spread(probe, 2);
  const double k0 = 2 * std::numbers::pi / spread.wavelength_m;
  const double noise = nyquistVelocity(probe, prf_hz) / (std::numbers::pi * (pulses - 1)) *
                       std::sqrt(kNoiseShare / gate);
  const double speckle = kPlateVelocity_m_s / (4 * k0 * spread.axial_m);
  double sum = 0, count = 0;
  for (int n = 1 - (pulses - 1); n < pulses - 1; ++n)
    for (int k = 1 - gate; k < gate; ++k) {
      const double share = (pulses - 1 - std::abs(n)) * (gate - std::abs(k));
      const double apart = n * kPlateVelocity_m_s / prf_hz + k * probe.sampleSpacing();
      sum += share * std::exp(-apart * apart / (2 * spread.axial_m * spread.axial_m));
      count += share;
    }
  return std::sqrt(noise * noise + speckle * speckle * sum / count);
}

struct Precision {
  double bias = 0, deviation = 0;  // m/s, weighted by power
};

Precision measured(const std::vector<std::vector<PulseField>>& beds, const Probe& probe, int pulses,
                   double prf_hz, double gate_m) {
  const double nyquist = nyquistVelocity(probe, prf_hz);
  double weight = 0, sum = 0, squares = 0;
  for (const std::vector<PulseField>& all : beds) {
    const VelocityPlanes planes =
        estimateVelocity(std::span(all).first(static_cast<std::size_t>(pulses)),
                         WallFilter(WallFilterKind::none, pulses), probe, prf_hz, gate_m);
    for (int i = 3; i < probe.lines - 3; ++i)
      for (int k = 12; k < probe.samples - 12; ++k) {
        const auto at = static_cast<std::size_t>(i * probe.samples + k);
        const double exact = -kPlateVelocity_m_s * lineGeometry(probe, i).direction.z;
        const double off =
            std::remainder(static_cast<double>(planes.velocity_m_s[at]) - exact, 2 * nyquist);
        const auto power = static_cast<double>(planes.power[at]);
        weight += power;
        sum += power * off;
        squares += power * off * off;
      }
  }
  const double bias = sum / weight;
  return {bias, std::sqrt(squares / weight - bias * bias)};
}

TEST(DopplerPrecision, DeviationsAreThoseOfTheClosedForm) {
  withThreads(0, [] {
    std::printf("| PRF, Hz | pulses | gate, mm | bias, mm/s | SD, mm/s | (D6), mm/s |\n");
    for (const double prf_hz : {500.0, 1000.0, 2000.0}) {
      Probe probe;
      std::vector<std::vector<PulseField>> beds;
      for (int seed = 1; seed <= kBeds; ++seed) beds.push_back(noisyPulses(seed, prf_hz, probe));
      for (const int pulses : {2, 4, 8, 16})
        for (const double gate_m : {0.0, 1e-3}) {
          const Precision found = measured(beds, probe, pulses, prf_hz, gate_m);
          const double closed =
              closedDeviation(probe, pulses, prf_hz, 2 * gateReach(probe, gate_m) + 1);
          std::printf("| %.0f | %d | %g | %.2f | %.2f | %.2f |\n", prf_hz, pulses, 1e3 * gate_m,
                      1e3 * found.bias, 1e3 * found.deviation, 1e3 * closed);
          EXPECT_LT(std::abs(found.bias), 0.2 * closed);
          EXPECT_NEAR(found.deviation, closed, 0.15 * closed);
        }
    }
  });
}

}  // namespace
}  // namespace echocine
