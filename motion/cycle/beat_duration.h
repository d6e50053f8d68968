#pragma once
// How long each beat of a loop lasts.

#include <cstdint>

#include "scene/scene.h"

namespace echocine {

// Time from the R wave of a beat (counted from 0) to the next, in s: the mean where the acquisition
// has no variability, else a normal number about it that is never over three standard deviations
// off. Depends on the seed and the beat alone. Our choice: beats vary independently of each other,
// without the slow waves of breathing and blood pressure.
double beatDuration(const Acquisition& acquisition, std::int64_t beat);

}  // namespace echocine
