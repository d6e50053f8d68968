#pragma once
// Time-gain compensation by a table of depth and gain.

#include <span>
#include <utility>
#include <vector>

#include "scene/probe.h"

namespace echocine {

// Intensity gain of each sample: the table's decibels, linear between its depths and constant
// beyond its ends. Precondition: at least one entry, ascending depths.
std::vector<float> timeGains(const std::vector<std::pair<double, double>>& table_m_db,
                             const Probe& probe);

// Gains that undo a loss at each sample; empty for no losses. Precondition: losses are positive.
std::vector<float> gainsAgainst(std::span<const double> losses);

// Gains that undo a medium of this amplitude attenuation (alpha, Np/m) along the whole path, both
// ways: exp(4 alpha r) at the path length r. At most 200 dB.
std::vector<float> nominalGains(double attenuation_np_per_m, const Probe& probe);

// Multiplies every line by the gains. plane.size() is a multiple of gains.size().
void applyTimeGains(std::span<const float> gains, std::span<float> plane);

}  // namespace echocine
