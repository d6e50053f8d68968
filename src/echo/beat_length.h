#pragma once
// The length of a beat, from the self-similarity of a loop.

#include <string>
#include <vector>

#include "echo/motion_features.h"

namespace echocine::echo {

struct BeatLength {
  double frames = 0;      // 0: not found
  double confidence = 0;  // 0..1: contrast of the similarity against that at other lags
  std::string source;  // "self-similarity", "loop closes", "manifest", "R waves", or a heart rate's
  std::vector<double> dissimilarity;  // by lag in frames; 0 for equal frames, 1 for unrelated ones
};

// d(L) = mean over j of |f_j - f_(j+L)|^2 / (2 mean |f|^2). The beat is the first lag at which d
// has fallen back most of the way, refined by a parabola through the lag and its neighbours. A
// whole number of beats is not taken for one: a lag replaces a half or a third of it only if frames
// are dissimilar at that (d >= 1). Lags range from `shortest` frames to the last one with two pairs
// of frames. A loop of one beat has no such lag; if its last frames return to its first, its length
// is the beat.
BeatLength findBeatLength(const Features& features, double shortest);

// The loop's beat from its file, its R waves, a heart rate, or its self-similarity.
BeatLength beatOf(const EchoLoop& loop);

}  // namespace echocine::echo
