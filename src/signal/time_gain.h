#pragma once
// Time-gain compensation by a table of depth and gain.

#include <span>
#include <utility>
#include <vector>

#include "scene/probe.h"

namespace echocine {

// Intensity gain of each sample: the table's decibels, linear between its depths and constant
// beyond its ends. Precondition: depths ascend, at least one entry.
std::vector<float> timeGains(const std::vector<std::pair<double, double>>& table_m_db,
                             const Probe& probe);

// What undoes a loss at each sample; none of no losses. Precondition: losses are over 0.
std::vector<float> gainsAgainst(std::span<const double> losses);

// What undoes a medium of this attenuation of amplitude (alpha, Np/m) along the whole path, both
// ways: exp(4 alpha r) at the path length r. At most 200 dB.
std::vector<float> nominalGains(double attenuation_np_per_m, const Probe& probe);

// Multiplies every line by the gains. plane.size() is a multiple of gains.size().
void applyTimeGains(std::span<const float> gains, std::span<float> plane);

}  // namespace echocine
