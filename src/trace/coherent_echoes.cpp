#include "trace/coherent_echoes.h"

#include <cmath>
#include <numbers>

namespace echocine {

EchoPhase::EchoPhase(double depth_m, double wavelength_m) {
  const double angle_rad = 2 * std::numbers::pi * std::remainder(2 * depth_m / wavelength_m, 1.0);
  real = std::cos(angle_rad);
  imaginary = -std::sin(angle_rad);
}

void addCoherent(std::span<const LineTrace> lines, const CellEchoes& cells,
                 const TraceSettings& settings, const Sampling& sampling,
                 const IntensityTerms& parts, CoherentEchoes& coherent) {
  if (!parts.reflection) return;
  const auto add = [&](std::size_t at, double depth_m, double intensity, double filled,
                       double exponent, double part) {
    if (part == 0) return;
    const double lost = parts.attenuation ? std::exp(-exponent) : 1.0;
    const double value = part * parts.echo_samples * parts.shown(intensity, filled) * lost;
    const EchoPhase phase(depth_m, settings.wavelength_m);
    coherent.intensity[at] += static_cast<float>(value);
    coherent.real[at] += static_cast<float>(value * phase.real);
    coherent.imaginary[at] += static_cast<float>(value * phase.imaginary);
  };
  const auto samples = static_cast<std::size_t>(sampling.samples);
  for (std::size_t i = 0; i < lines.size(); ++i)
    for (const Echo& echo : lines[i].echoes) {
      const double k = std::floor((echo.depth_m - sampling.min_depth_m) / sampling.spacing_m);
      if (k < 0 || k >= sampling.samples) continue;
      add(i * samples + static_cast<std::size_t>(k), echo.depth_m, echo.intensity, echo.intensity,
          echo.exponent, settings.surfaces[index(echo.surface)].coherent_part);
    }
  for (std::size_t j = 0; j < cells.count; ++j) {
    const double k =
        static_cast<double>(cells.at[j] % samples) + static_cast<double>(cells.place[j]);
    add(cells.at[j], sampling.min_depth_m + k * sampling.spacing_m, cells.intensity[j],
        cells.filled[j], cells.exponent[j], static_cast<double>(cells.coherent_part[j]));
  }
}

}  // namespace echocine
