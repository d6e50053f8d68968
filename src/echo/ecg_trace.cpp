#include "echo/ecg_trace.h"

#include <algorithm>
#include <cmath>

#include "echo/ecg_time.h"
#include "echo/ecg_waves.h"

namespace echocine::echo {

namespace {

// Beats a second that hearts have: 20 to 300 a minute, where the rate of frames is that of the
// acquisition.
bool isABeat(double frames, const FrameRate& rate) {
  if (frames < 3) return false;
  return !rate.trusted || !(rate.hz > 0) || (frames >= 0.2 * rate.hz && frames <= 3 * rate.hz);
}

EcgTrace traceOf(const EcgSignal& signal, const EcgCurve& curve, const Video& video) {
  const RWaves waves = findRWaves(signal.height_px, curve.thickness_px);
  EcgTrace out{signal.kind,
               curve.band.left,
               curve.band.right,
               curve.band.top,
               curve.band.bottom,
               signal.px_per_frame,
               {},
               0,
               0};
  for (const double at : waves.at) out.r_frames.push_back(signal.instantOf(at));
  std::vector<double> steps;
  for (std::size_t i = 1; i < out.r_frames.size(); ++i)
    steps.push_back(out.r_frames[i] - out.r_frames[i - 1]);
  if (!steps.empty()) {
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    out.beat_frames = *middle;
    if (!isABeat(out.beat_frames, video.rate)) return out;
  }
  const bool within = std::any_of(out.r_frames.begin(), out.r_frames.end(),
                                  [&](double f) { return f >= 0 && f <= video.frameCount() - 1; });
  if (within) out.confidence = signal.confidence * waves.confidence;
  return out;
}

}  // namespace

std::optional<EcgTrace> readEcg(const Video& video, const Sector& sector, double least_confidence) {
  std::optional<EcgTrace> best;
  for (const CurveBand& band : curveBands(video, sector)) {
    const EcgCurve curve = curveIn(band, video, sector);
    for (const auto& signal : {signalOfHead(curve), signalOfScroll(curve)}) {
      if (!signal) continue;
      EcgTrace trace = traceOf(*signal, curve, video);
      if (trace.confidence > (best ? best->confidence : 0.0)) best = std::move(trace);
    }
  }
  if (best && best->confidence < least_confidence) best.reset();
  return best;
}

std::vector<double> rWavesWithin(const EcgTrace& trace, int frames) {
  std::vector<double> out;
  for (const double r : trace.r_frames)
    if (r >= 0 && r <= frames - 1) out.push_back(r);
  return out;
}

std::optional<EcgBeat> usualBeat(const EcgTrace& trace, int frames) {
  std::optional<EcgBeat> best;
  double least = 0;
  for (std::size_t i = 0; i + 1 < trace.r_frames.size(); ++i) {
    const EcgBeat beat{trace.r_frames[i], trace.r_frames[i + 1] - trace.r_frames[i]};
    if (beat.r_frame < 0 || beat.r_frame > frames - 1) continue;
    const double missing = std::max(0.0, beat.r_frame + beat.frames - frames),
                 off = std::abs(beat.frames - trace.beat_frames) + missing;
    if (!best || off < least) best = beat, least = off;
  }
  return best;
}

}  // namespace echocine::echo
