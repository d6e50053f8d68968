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
  // At shorter paths 1/l^2 is constant: one wavelength. Closer to the transducer there is no
  // spherical wave, and the value would depend on the position of the first sample.
  double spread_from_m = 0;

  double centre(double k) const { return min_depth_m + (k + 0.5) * spacing_m; }
};

// The paper's factors contained in the intensity of a sample.
struct IntensityTerms {
  bool reflection = true, backscatter = true;
  bool attenuation = true;
  // 0: the backscattered part falls as 1/l^2. Otherwise every sample is scaled as if at this path
  // length.
  double spread_undone_at_m = 0;
  // An interface's echo has the length of the pulse: its sample contains its intensity times half
  // the pulse's length over the spacing, so the average over the pulse is the intensity itself for
  // any spacing. At least 1.
  double echo_samples = 1;
  // For interface echoes in the picture: a factor, and an upper limit; 0: no limit.
  double echo_gain = 1, echo_limit = 0;

  // The echo of a part of an interface, where the whole interface has the echo `filled`. The limit
  // is that of the whole, so a wall's brightness does not depend on the parts into which samples,
  // lines and facets divide it.
  template <typename Number>
  Number shown(Number echo, Number filled) const {
    const Number gained = echo * echo_gain;
    return echo_limit > 0 ? gained / (1 + filled * (echo_gain / echo_limit)) : gained;
  }
};

// I_R of section 4.1 relative to I_S: eta_b V / l^2 exp(-A) prod (1-R)^2 at each sample's centre,
// plus echo_samples times the echoes of the interfaces in its depth interval. Relative error of the
// backscattered part below 1e-6. Behind the end of the ray every sample is exactly 0. values.size()
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
