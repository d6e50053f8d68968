#pragma once
// End-diastole among keyframes: one rule for the placing of a probe and for the measuring of a
// view.

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "scene/role.h"
#include "scene/scene.h"

namespace echocine {

// The structure whose volume gives end-diastole: the left ventricle's cavity, otherwise its wall.
std::optional<SurfaceId> ventricleOf(const Scene& scene);

// The keyframe of the largest volume, whatever its sign; the first of several.
std::size_t largestKeyframe(std::size_t keyframes,
                            const std::function<double(std::size_t)>& volumeOf);

// The keyframe nearest to a phase in the cycle; the first of several. Precondition: at least one.
std::size_t nearestKeyframe(double phase, std::span<const double> phases);

}  // namespace echocine
