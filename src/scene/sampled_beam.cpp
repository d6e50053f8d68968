#include "scene/sampled_beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Frequencies stand one deviation of the spectrum apart. Echoes weaken with frequency on the way
// through the aperture, so their centre lies lower: measured with the simulator named in the
// header.
constexpr int kFrequencies = 5;
constexpr double kCentre = 0.963;

// Largest u that lines reach; nothing is sent beyond a right angle.
constexpr double kMostU = 2;
// Entries in a beam's width lambda / D, and of phase at the edge of the aperture between two
// defocuses: linear interpolation is then within 1 % of the peak's thousandth part. Our choices.
constexpr double kStepsPerWidth = 16, kEdgePhase = std::numbers::pi / 8;
// Bounds of the table for apertures of very many wavelengths or very few. Our choices.
constexpr std::size_t kMostElements = 128, kLeastElements = 2, kMostDefocuses = 256;
// Share of the u of the first grating lobe that lines reach at most; P counts as 0 beyond it.
constexpr double kGratingShare = 0.9;

constexpr double kMainLobeEnd = 1e-3;

// Share of the centre frequency: spectra of less than a cycle reach down to 0. Our choice.
constexpr double kLeastFrequency = 0.1;

// Amplitude of an element at a place from -1 to 1 of the aperture.
double weightOf(Apodization apodization, double place) {
  const double bell = 0.5 * (1 + std::cos(std::numbers::pi * place));
  switch (apodization) {
    case Apodization::uniform:
      return 1;
    case Apodization::hann:
      return bell;
    case Apodization::hamming:
      return 0.08 + 0.92 * bell;
  }
  return 1;
}

// The highest frequency of the sum over the centre frequency.
double highestFrequency(const Probe& probe, double pulse_cycles) {
  return kCentre + (kFrequencies / 2) * spectrumDeviation(pulse_cycles, probe.bandwidth);
}

double nearestPath(double aperture_m) {
  return 0.5 * aperture_m;
}

}  // namespace

// Full width at -6 dB of N cycles, sinc^2 = 1/4: 1.207 f / N. A Gaussian of amplitude has it at
// sqrt(8 ln 2) deviations. Both factors multiply; the square of a Gaussian is narrower by sqrt 2.
double spectrumDeviation(double pulse_cycles, double bandwidth) {
  const double deviations = std::sqrt(8 * std::numbers::ln2);
  const double inverse = std::hypot(deviations * pulse_cycles / 1.2067, deviations / bandwidth);
  return 1 / (std::numbers::sqrt2 * inverse);
}

namespace {

double deviationOfPupil(Apodization receive, bool harmonic) {
  constexpr int kElements = 128;
  const auto placeOf = [](int n) { return (2 * n + 1.0) / kElements - 1; };
  double sum = 0, squares = 0;
  for (int shift = -kElements + 1; shift < kElements; ++shift) {
    double both = 0;  // H: the sent aperture over the receiving one
    for (int n = std::max(shift, 0); n < kElements + std::min(shift, 0); ++n)
      both += weightOf(receive, placeOf(n)) * (harmonic ? 1 - std::abs(placeOf(n - shift)) : 1);
    sum += both * both;
    squares += both * both * shift * shift;
  }
  return std::sqrt(squares / sum);
}

}  // namespace

double speckleWidening(Apodization receive, bool harmonic) {
  return receive == Apodization::uniform && !harmonic
             ? 1
             : deviationOfPupil(Apodization::uniform, false) / deviationOfPupil(receive, harmonic);
}

double receivingPart(const Probe& probe, double f_number, double path_m) {
  constexpr double kLeast = 0.25;
  return f_number > 0 ? std::clamp(path_m / (f_number * probe.aperture_m), kLeast, 1.0) : 1;
}

double downshiftOf(const Probe& probe, double pulse_cycles, double attenuation_np_per_m_hz,
                   double path_m) {
  constexpr double kLeast = 0.5;
  const double deviation = spectrumDeviation(pulse_cycles, probe.bandwidth);
  return std::max(
      1 - 4 * attenuation_np_per_m_hz * path_m * deviation * deviation * probe.frequency_hz,
      kLeast);
}

SampledBeam::SampledBeam(const Probe& probe, double pulse_cycles, bool harmonic)
    : aperture_m_(probe.aperture_m), focus_m_(probe.focus_m) {
  const double wavelength_m = ScanGeometry(probe).wavelength(), half_m = 0.5 * aperture_m_;
  const double nearest_m = std::max(probe.min_depth_m, nearestPath(aperture_m_));
  const double farthest_m = std::max(probe.max_depth_m, nearest_m);
  // cos^2(theta) only brings a defocus nearer to 0.
  first_defocus_ = std::min(1 / farthest_m - 1 / focus_m_, 0.0);
  const double last = std::max(1 / nearest_m - 1 / focus_m_, 0.0);
  const double step = kEdgePhase * wavelength_m / (std::numbers::pi * half_m * half_m);
  defocuses_ = 2 + static_cast<std::size_t>(
                       std::min((last - first_defocus_) / step, double{kMostDefocuses}));
  defocus_step_ = std::max((last - first_defocus_) / static_cast<double>(defocuses_ - 1), 1e-9);
  const double widths = std::max(aperture_m_ / wavelength_m, 1.0);
  const double shortest = widths * highestFrequency(probe, pulse_cycles);  // in the aperture
  const double most_u = std::min(kMostU, kGratingShare * double{kMostElements} / shortest);
  steps_ = static_cast<std::size_t>(std::ceil(most_u * kStepsPerWidth * widths)) + 1;
  steps_per_u_ = static_cast<double>(steps_ - 1) / most_u;
  fill(probe, pulse_cycles, harmonic);
}

namespace {

// The half of an aperture with x >= 0; the other half mirrors it.
struct HalfAperture {
  std::vector<double> places_m, transmit, receive;  // by element

  HalfAperture(const Probe& probe, double shortest_m) {
    const double wanted = std::ceil(kMostU / kGratingShare * probe.aperture_m / shortest_m);
    const auto elements =
        static_cast<std::size_t>(std::clamp(wanted, double{kLeastElements}, double{kMostElements}));
    const double middle = 0.5 * static_cast<double>(elements - 1);
    const double pitch_m = probe.aperture_m / static_cast<double>(elements);
    for (std::size_t n = elements / 2; n < elements; ++n) {
      const double place_m = (static_cast<double>(n) - middle) * pitch_m;
      const double mirrored = place_m > 0 ? 2 : 1;
      places_m.push_back(place_m);
      transmit.push_back(mirrored);
      receive.push_back(mirrored *
                        weightOf(probe.receive_apodization, 2 * place_m / probe.aperture_m));
    }
  }
  std::size_t size() const { return places_m.size(); }
};

// Powers of a frequency by u, for any defocus.
class FrequencyPowers {
 public:
  FrequencyPowers(const HalfAperture& aperture, double wave_number, bool harmonic,
                  std::size_t steps, double steps_per_u)
      : aperture_(aperture),
        sent_wave_number_(harmonic ? 0.5 * wave_number : wave_number),
        harmonic_(harmonic),
        receive_(steps, 0.0) {
    for (std::size_t n = 0; n < aperture.size(); ++n)
      for (std::size_t s = 0; s < steps; ++s) {
        const double across = wave_number * static_cast<double>(s) / steps_per_u;
        const double received = std::cos(across * aperture.places_m[n]);
        const double sent = harmonic ? std::cos(0.5 * across * aperture.places_m[n]) : received;
        cosines_.push_back(sent * aperture.transmit[n]);
        receive_[s] += received * aperture.receive[n];
      }
    for (double& power : receive_) power *= power;
  }

  void add(double defocus, double weight, double* powers) const {
    const std::size_t steps = receive_.size();
    std::vector<double> real(steps, 0.0), imaginary(steps, 0.0);
    for (std::size_t n = 0; n < aperture_.size(); ++n) {
      const double x = aperture_.places_m[n], phase = 0.5 * sent_wave_number_ * x * x * defocus;
      const double cosine = std::cos(phase), sine = std::sin(phase);
      const double* const across = &cosines_[n * steps];
      for (std::size_t s = 0; s < steps; ++s) {
        real[s] += across[s] * cosine;
        imaginary[s] -= across[s] * sine;
      }
    }
    for (std::size_t s = 0; s < steps; ++s) {
      const double sent = real[s] * real[s] + imaginary[s] * imaginary[s];
      powers[s] += weight * (harmonic_ ? sent * sent : sent) * receive_[s];
    }
  }

 private:
  const HalfAperture& aperture_;
  double sent_wave_number_;
  bool harmonic_;
  std::vector<double> cosines_, receive_;  // by element and u; by u
};

}  // namespace

void SampledBeam::fill(const Probe& probe, double pulse_cycles, bool harmonic) {
  const double wavelength_m = ScanGeometry(probe).wavelength();
  const HalfAperture aperture(probe, wavelength_m / highestFrequency(probe, pulse_cycles));
  const double deviation = spectrumDeviation(pulse_cycles, probe.bandwidth);
  std::vector<double> powers(defocuses_ * steps_, 0.0);
  for (int f = 0; f < kFrequencies; ++f) {
    const double away = f - kFrequencies / 2;
    const double relative = std::max(kCentre + away * deviation, kLeastFrequency);
    const FrequencyPowers of_frequency(aperture, 2 * std::numbers::pi / wavelength_m * relative,
                                       harmonic, steps_, steps_per_u_);
    parallelBlocks(defocuses_, 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t d = begin; d < end; ++d)
        of_frequency.add(first_defocus_ + static_cast<double>(d) * defocus_step_,
                         std::exp(-0.5 * away * away), &powers[d * steps_]);
    });
  }
  for (std::size_t d = 0; d < defocuses_; ++d) integrate({&powers[d * steps_], steps_});
}

// Appends a row.
void SampledBeam::integrate(std::span<const double> powers) {
  const double peak = *std::max_element(powers.begin(), powers.end());
  // The main lobe ends in the nearer half, or nowhere: a defocused grating lobe may reach the end.
  std::size_t last = powers.size() / 2;
  if (powers[last] >= kMainLobeEnd * peak) last = powers.size() - 1;
  while (last > 0 && powers[last] < kMainLobeEnd * peak) --last;
  main_lobes_.push_back(static_cast<double>(last + 1) / steps_per_u_);
  std::vector<double> sums{0.0};
  for (std::size_t s = 1; s < powers.size(); ++s)
    sums.push_back(sums.back() + 0.5 * (powers[s - 1] + powers[s]));
  const double scale = 0.5 / sums.back();
  for (std::size_t s = 0; s < powers.size(); ++s)
    entries_.push_back({scale * sums[s], scale * powers[s]});
}

double SampledBeam::defocus(double path_m, double steering) const {
  const double held_m = std::max(path_m, nearestPath(aperture_m_));
  return (1 - steering * steering) * (1 / held_m - 1 / focus_m_);
}

SampledBeam::Profile SampledBeam::at(double defocus) const {
  const double place = std::clamp((defocus - first_defocus_) / defocus_step_, 0.0,
                                  static_cast<double>(defocuses_ - 1));
  const auto row = std::min(static_cast<std::size_t>(place), defocuses_ - 2);
  Profile profile;
  profile.low_ = &entries_[row * steps_];
  profile.high_ = profile.low_ + steps_;
  profile.share_ = place - static_cast<double>(row);
  profile.steps_per_u_ = steps_per_u_;
  profile.last_ = steps_ - 1;
  profile.main_lobe_ = std::max(main_lobes_[row], main_lobes_[row + 1]);
  return profile;
}

// P is linear between two entries.
double SampledBeam::Profile::integral(double u) const {
  const double place = std::min(std::abs(u) * steps_per_u_, static_cast<double>(last_));
  const auto step = std::min(static_cast<std::size_t>(place), last_ - 1);
  const double part = place - static_cast<double>(step);
  const auto of = [&](const Entry* row) {
    const Entry &a = row[step], &b = row[step + 1];
    return a.integral + part * (a.power + 0.5 * part * (b.power - a.power));
  };
  const double low = of(low_), value = low + share_ * (of(high_) - low);
  return u < 0 ? -value : value;
}

}  // namespace echocine
