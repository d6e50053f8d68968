// The beat of a loop: by its file, its R waves, a heart rate, or its self-similarity.

#include <algorithm>

#include "echo/beat_length.h"
#include "echo/r_wave_beats.h"
#include "echo/resample.h"

namespace echocine::echo {

namespace {

// 200 beats a minute at a rate that is known; otherwise an eighth of the loop.
double shortestBeat(const EchoLoop& loop) {
  constexpr double kShortest_s = 0.3;
  return loop.video.rate.trusted && loop.video.rate.hz > 0
             ? kShortest_s * loop.video.rate.hz
             : static_cast<double>(loop.video.frames.size()) / 8;
}

// Motion in a loop's own sector, independent of the other loop. Features are coarse, so a coarse
// grid is enough.
Features ownFeatures(const EchoLoop& loop) {
  BeamGrid grid = commonGrid(loop, loop);
  grid.lines = std::min(grid.lines, 128);
  grid.samples = std::min(grid.samples, 192);
  const BeamLoop beams = resample(grid, loop);
  return motionFeatures(grid, beams, areaWeights(grid, beams.valid, beams.valid));
}

}  // namespace

BeatLength beatOf(const EchoLoop& loop) {
  BeatLength beat = findBeatLength(ownFeatures(loop), shortestBeat(loop));
  const auto known = [&](double frames, const std::string& source) {
    beat.frames = frames;
    beat.confidence = 1;
    beat.source = source;
  };
  const Video& v = loop.video;
  const bool has_rate = v.heart_rate_bpm && v.rate.trusted,
             is_given = v.heart_rate_source.starts_with("--");
  const auto byRate = [&] { known(60 / *v.heart_rate_bpm * v.rate.hz, v.heart_rate_source); };
  if (has_rate && is_given)
    byRate();
  else if (loop.frames_per_beat > 0)
    known(loop.frames_per_beat, "manifest");
  else if (v.r_waves_s.size() > 1 && v.rate.hz > 0)
    known(beatOfRWaves(v.r_waves_s, beat.frames / v.rate.hz).mean * v.rate.hz, "R waves");
  else if (loop.ecg && loop.ecg->beat_frames > 0 && !is_given)
    beat = {beatOfRWaves(loop.ecg->r_frames, beat.frames).median, loop.ecg->confidence,
            loop.beat_anchor, beat.dissimilarity};
  else if (has_rate)
    byRate();
  return beat;
}

}  // namespace echocine::echo
