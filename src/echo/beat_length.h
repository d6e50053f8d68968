#pragma once
// The length of a beat, found from how a loop resembles itself a while later.

#include <string>
#include <vector>

#include "echo/motion_features.h"

namespace echocine::echo {

struct BeatLength {
  double frames = 0;      // 0: not found
  double confidence = 0;  // 0..1: how far the resemblance stands out from that at other lags
  std::string source;  // "self-similarity", "loop closes", "manifest", "R waves", or a heart rate's
  std::vector<double> dissimilarity;  // by lag in frames, 0 for equal frames, 1 for unrelated ones
};

// d(L) = mean over j of |f_j - f_(j+L)|^2 / (2 mean |f|^2). The beat is the first lag at which d
// has fallen back most of its way, refined by a parabola through the lag and its neighbours. Lags
// go from `shortest` frames up to the last that two pairs of frames support. A loop of one beat has
// no such lag; when its last frames come back to its first, its length is the beat.
BeatLength findBeatLength(const Features& features, double shortest);

// The loop's beat by its file, its R waves, a heart rate, or its self-similarity.
BeatLength beatOf(const EchoLoop& loop);

}  // namespace echocine::echo
