#pragma once
// Samples of a scan line from its segments and echoes.

#include <cstdint>
#include <span>

#include "trace/line_trace.h"

namespace echocine {

// Sample k is centred at min_depth + (k + 1/2) spacing and spans one spacing.
struct Sampling {
  double min_depth_m = 0, spacing_m = 0;
  int samples = 0;
  // Nearer than this 1/l^2 stays as it is there: a wavelength. Closer to the transducer there is no
  // spherical wave, and the law's own value would only tell where the first sample happens to lie.
  double spread_from_m = 0;

  double centre(double k) const { return min_depth_m + (k + 0.5) * spacing_m; }
};

// Which of the paper's factors the intensity of a sample holds.
struct IntensityTerms {
  bool reflection = true, backscatter = true;
  bool attenuation = true;
  // 0: the backscattered part falls as 1/l^2. Else it stands as if every sample were at this path
  // length.
  double spread_undone_at_m = 0;
  // An interface's echo is as long as the pulse: its sample holds so many times its intensity, the
  // pulse's half length over the spacing, so that the average over the pulse is the intensity
  // itself whatever the spacing. At least 1.
  double echo_samples = 1;
  // Of interface echoes in the picture: a factor, and what it tends to; 0: no limit.
  double echo_gain = 1, echo_limit = 0;

  template <typename Number>
  Number shown(Number echo) const {
    const Number gained = echo * echo_gain;
    return echo_limit > 0 ? gained / (1 + gained / echo_limit) : gained;
  }
};

// I_R of section 4.1 relative to I_S: eta_b V / l^2 exp(-A) prod (1-R)^2 at each sample's centre,
// plus echo_samples times the echoes of the interfaces in its depth interval. Relative error of the
// backscattered part under 1e-6. Behind the end of the ray every sample is exactly 0. values.size()
// == sampling.samples.
void sampleIntensity(const LineTrace& line, const Sampling& sampling, const IntensityTerms& parts,
                     std::span<float> values);

// Adds a frame's cell echoes to the samples of its lines; the attenuation to 1e-12.
void addToSamples(const CellEchoes& echoes, const IntensityTerms& parts, std::span<float> plane);

// A in nepers at each sample's centre; 0 behind the end of the ray.
void sampleExponent(const LineTrace& line, const Sampling& sampling, std::span<float> values);

// Medium at each sample's centre; kNoMedium behind the end of the ray.
inline constexpr std::uint32_t kNoMedium = 0xffffffffu;
void sampleMedium(const LineTrace& line, const Sampling& sampling, std::span<std::uint32_t> ids);

}  // namespace echocine
