#pragma once
// White of a scene without absolute reference and percentile.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// SignalSettings::reference_percentile of a scene whose white follows the heart's muscle; not a
// valid percentile.
inline constexpr double kWhiteByMuscle = 0;
// The percentile of a scene without muscle.
inline constexpr double kDefaultPercentile = 99.5;

// Grey level of the median of the muscle's samples: that of the myocardium in 288 apical
// four-chamber stills, 97 at end-diastole and 102 at end-systole (Leclerc et al., IEEE TMI 38(9),
// 2198-2210, 2019).
inline constexpr double kMuscleGrey = 100;

// By MediumId: is it heart muscle? In a scene with a chamber or a wall of the heart, by role, these
// are the media of walls, papillary muscles and the epicardium, and the medium "myocardium" of any
// closed structure. If there is none, it is the background around the chambers. A chamber's own
// medium is never muscle. None in all other scenes.
std::vector<char> muscleMedia(const Scene& scene);

// Does white follow the muscle, and is there any?
bool isWhiteByMuscle(const Scene& scene);

// The rule that selects white, in words: "heart muscle at grey 100", ...
std::string whiteWords(const Scene& scene);

// White / median of the muscle, a ratio of intensities that gives the median kMuscleGrey.
double whiteOverMuscle(const SignalSettings& signal);

}  // namespace echocine
