#pragma once
// The ECG beside the sector of a video: times of its R waves.

#include <optional>
#include <string>
#include <vector>

#include "echo/sector.h"

namespace echocine::echo {

struct EcgTrace {
  std::string kind;                              // "sweeping", "scrolling", "still, with a marker"
  int left = 0, right = 0, top = 0, bottom = 0;  // px of the picture, ends included
  double px_per_frame = 0;                       // measured from the video
  // R waves in frames, from the first; including visible ones before or after the loop.
  std::vector<double> r_frames;
  double beat_frames = 0;  // median interval of R waves; 0: only one
  // 0..1: share of the frames that the motion explains, times the distinctness of R waves.
  double confidence = 0;
};

// Traces below this are discarded. Our choice: traces planted in tests have at least 0.59; other
// structures have 0.
inline constexpr double kEcgConfident = 0.4;

// The trace of highest confidence, if it is sufficient and an R wave is within the loop: sweeping,
// scrolling to the left, or static with a marker that moves to the right. Colour is ignored.
std::optional<EcgTrace> readEcg(const Video& video, const Sector& sector,
                                double least_confidence = kEcgConfident);

// R waves within a loop of the given number of frames.
std::vector<double> rWavesWithin(const EcgTrace& trace, int frames);

// The beat in the loop of most typical length; complete beats are preferred. None if no R wave is
// followed by another.
struct EcgBeat {
  double r_frame = 0, frames = 0;
};
std::optional<EcgBeat> usualBeat(const EcgTrace& trace, int frames);

}  // namespace echocine::echo
