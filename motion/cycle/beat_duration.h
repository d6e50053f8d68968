#pragma once
// Durations of the beats of a loop.

#include <cstdint>

#include "scene/scene.h"

namespace echocine {

// Time from the R wave of a beat (counted from 0) to the next, s: the mean without variability,
// otherwise a normal number limited to three standard deviations. Depends only on the seed and the
// beat. Our choice: beats vary independently, without the slow waves of respiration and blood
// pressure.
double beatDuration(const Acquisition& acquisition, std::int64_t beat);

}  // namespace echocine
