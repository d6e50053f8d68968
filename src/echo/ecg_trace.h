#pragma once
// The ECG that a video shows beside its sector: where in time its R waves lie.

#include <optional>
#include <string>
#include <vector>

#include "echo/sector.h"

namespace echocine::echo {

struct EcgTrace {
  std::string kind;                              // "sweeping", "scrolling", "still, with a marker"
  int left = 0, right = 0, top = 0, bottom = 0;  // px of the picture, ends included
  double px_per_frame = 0;                       // measured from the video itself
  // R waves in frames, from the first; those that the trace shows from before or after the loop
  // too.
  std::vector<double> r_frames;
  double beat_frames = 0;  // median of the steps from R wave to R wave; 0: one alone
  // 0..1: the part of the frames that the movement explains, times how far R waves stand out.
  double confidence = 0;
};

// Traces below this are not taken. Our choice: those that tests plant have 0.59 and more, what is
// no trace has 0.
inline constexpr double kEcgConfident = 0.4;

// The trace of most confidence, where one has enough and an R wave within the loop: sweeping or
// scrolling to the left, or still with a marker that runs to the right. Colour plays no part.
std::optional<EcgTrace> readEcg(const Video& video, const Sector& sector,
                                double least_confidence = kEcgConfident);

// R waves within a loop of so many frames.
std::vector<double> rWavesWithin(const EcgTrace& trace, int frames);

// The beat in the loop whose length is nearest to the usual one; whole ones first. Nothing where no
// R wave is followed by another.
struct EcgBeat {
  double r_frame = 0, frames = 0;
};
std::optional<EcgBeat> usualBeat(const EcgTrace& trace, int frames);

}  // namespace echocine::echo
