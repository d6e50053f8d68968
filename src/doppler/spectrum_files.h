#pragma once
// A spectrum as picture, EXR and CSV.

#include <cstddef>
#include <string>
#include <vector>

#include "doppler/spectrum.h"

namespace echocine {

// Time to the right, velocity up from -v_N to v_N; grey over 40 dB below the strongest bin, a line
// at 0. Two pixels per bin, one per column.
GreyImage spectrumPicture(const Spectrum& spectrum);

// Channel power; rows from v_N down to -v_N.
std::vector<std::byte> spectrumExr(const Spectrum& spectrum, double prf_hz, double step_s);

// time_s, phase, velocity_m_s, exact_m_s (empty without tissue).
std::string spectrumCsv(const Spectrum& spectrum);

}  // namespace echocine
