#pragma once
// What is white where a scene names neither an absolute reference nor a percentile.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// SignalSettings::reference_percentile of a scene that leaves it and the absolute reference to the
// heart's muscle; no percentile that can be asked for.
inline constexpr double kWhiteByMuscle = 0;
// The percentile where there is no muscle to go by.
inline constexpr double kDefaultPercentile = 99.5;

// The grey at which the median of the muscle's samples comes out: that of the myocardium in 288
// apical four-chamber stills, 97 at end-diastole and 102 at end-systole (Leclerc et al., IEEE TMI
// 38(9), 2198-2210, 2019).
inline constexpr double kMuscleGrey = 100;

// By MediumId, whether it is heart muscle. In a scene with a chamber or a wall of the heart, by its
// role: the media of walls, papillary muscles and the epicardium, and the medium "myocardium" of
// any closed structure; where no structure is such, the background in which the chambers lie. Never
// a chamber's own. None in all other scenes.
std::vector<char> muscleMedia(const Scene& scene);

// Does the scene leave white to its muscle, and has some?
bool isWhiteByMuscle(const Scene& scene);

// What decides white, in words: "heart muscle at grey 100", ...
std::string whiteWords(const Scene& scene);

// White over the muscle's median, as a ratio of intensities, with which that median has
// kMuscleGrey.
double whiteOverMuscle(const SignalSettings& signal);

}  // namespace echocine
