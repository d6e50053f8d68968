#include "doppler/autocorrelation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/parallel.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// (D1), of one sample or of a gate.
struct Correlations {
  double power = 0, real = 0, imaginary = 0;

  Correlations& operator+=(const Correlations& other) {
    power += other.power;
    real += other.real;
    imaginary += other.imaginary;
    return *this;
  }
};

// The packet of one sample.
struct Packet {
  std::vector<double> real, imaginary;
};

Correlations correlationsOf(const Packet& z) {
  Correlations sum;
  for (std::size_t n = 0; n + 1 < z.real.size(); ++n) {
    const double ar = z.real[n], ai = z.imaginary[n], br = z.real[n + 1], bi = z.imaginary[n + 1];
    sum += {0.5 * (ar * ar + ai * ai + br * br + bi * bi), ar * br + ai * bi, ai * br - ar * bi};
  }
  return sum;
}

// (D2), (D3).
void put(const Correlations& r, double nyquist, double terms, std::size_t at, VelocityPlanes& to) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  to.power[at] = static_cast<float>(r.power / terms);
  const bool some = to.power[at] > 0;
  const double per_turn = nyquist / std::numbers::pi;
  const double unlike = some ? std::max(0.0, 1 - std::hypot(r.real, r.imaginary) / r.power) : 0;
  to.velocity_m_s[at] =
      some ? static_cast<float>(-per_turn * std::atan2(r.imaginary, r.real)) : kNone;
  to.variance_m2_s2[at] = some ? static_cast<float>(2 * per_turn * per_turn * unlike) : kNone;
}

}  // namespace

double nyquistVelocity(const Probe& probe, double prf_hz) {
  return ScanGeometry(probe).wavelength() * prf_hz / 4;
}

int gateReach(const Probe& probe, double gate_m) {
  return std::max(0, static_cast<int>(std::lround((gate_m / probe.sampleSpacing() - 1) / 2)));
}

VelocityPlanes estimateVelocity(std::span<const PulseField> pulses, const WallFilter& filter,
                                const Probe& probe, double prf_hz, double gate_m) {
  const auto lines = static_cast<std::size_t>(probe.lines);
  const int samples = probe.samples, reach = gateReach(probe, gate_m);
  const double nyquist = nyquistVelocity(probe, prf_hz);
  VelocityPlanes planes;
  for (std::vector<float>* plane : {&planes.velocity_m_s, &planes.variance_m2_s2, &planes.power})
    plane->resize(lines * static_cast<std::size_t>(samples));
  parallelBlocks(lines, 8, [&](std::size_t begin, std::size_t end) {
    Packet z{std::vector<double>(pulses.size()), std::vector<double>(pulses.size())};
    std::vector<Correlations> of_line(static_cast<std::size_t>(samples));
    for (std::size_t line = begin; line < end; ++line) {
      const std::size_t first = line * static_cast<std::size_t>(samples);
      for (std::size_t k = 0; k < of_line.size(); ++k) {
        for (std::size_t n = 0; n < pulses.size(); ++n) {
          z.real[n] = static_cast<double>(pulses[n].real[first + k]);
          z.imaginary[n] = static_cast<double>(pulses[n].imaginary[first + k]);
        }
        if (!filter.passesAll()) {
          filter.apply(z.real);
          filter.apply(z.imaginary);
        }
        of_line[k] = correlationsOf(z);
      }
      for (int k = 0; k < samples; ++k) {
        const int from = std::max(k - reach, 0), to = std::min(k + reach, samples - 1);
        Correlations sum;
        for (int i = from; i <= to; ++i) sum += of_line[static_cast<std::size_t>(i)];
        const double terms = (to - from + 1.0) * (static_cast<double>(pulses.size()) - 1);
        put(sum, nyquist, terms, first + static_cast<std::size_t>(k), planes);
      }
    }
  });
  return planes;
}

}  // namespace echocine
