#include "compare/time_anchors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "echo/r_wave_beats.h"

namespace echocine::compare {

namespace {

// Frames of end-diastole and end-systole, which may lie between two; nothing where not known.
struct Cardinal {
  std::optional<double> ed, es;
};

// Those of a render: the largest and smallest volume of the left ventricle's cavity, else of the
// structure that empties most.
Cardinal fromVolumes(const echo::EchoLoop& loop) {
  const std::vector<double>* best = nullptr;
  double most = 0.05;
  for (const auto& [name, ml] : loop.volumes_ml) {
    if (ml.size() != loop.video.frames.size()) continue;
    const auto [low, high] = std::minmax_element(ml.begin(), ml.end());
    const double emptied = *high > 0 ? (1 - *low / *high) * (name == loop.lv_cavity ? 10 : 1) : 0;
    if (emptied > most) most = emptied, best = &ml;
  }
  if (best == nullptr) return {};
  return {static_cast<double>(std::max_element(best->begin(), best->end()) - best->begin()),
          static_cast<double>(std::min_element(best->begin(), best->end()) - best->begin())};
}

// The user's word goes before the volumes.
Cardinal cardinalOf(const echo::EchoLoop& loop, const echo::SideOptions& side) {
  Cardinal c = fromVolumes(loop);
  if (side.ed_frame) c.ed = side.ed_frame;
  if (side.es_frame) c.es = side.es_frame;
  for (const auto& frame : {c.ed, c.es})
    if (frame && !(*frame >= 0 && *frame < loop.video.frameCount()))
      throw SceneError(fmt::format("{}: ED or ES frame {} is not in the loop, accepted: 0 to {}",
                                   loop.video.name, *frame, loop.video.frameCount() - 1));
  return c;
}

// s: of the synthetic loop, r: of the real one, where either has to be known. beat: of the
// synthetic one, in frames.
std::vector<Anchor> byMarks(const Cardinal& s, const Cardinal& r, double beat,
                            const std::string& synthetic_name) {
  const auto missing = [&](const char* which) {
    throw SceneError(fmt::format("{}: its {} frame is not known; give --synthetic-{}",
                                 synthetic_name, which, which));
  };
  if (r.ed && !s.ed) missing("ed");
  if (r.es && !s.es) missing("es");
  std::vector<Anchor> anchors;
  if (r.ed) anchors.push_back({*r.ed, *s.ed});
  if (!r.es) return anchors;
  double place = *s.es;
  if (r.ed && beat > 0) {  // after ED where the real one is, else before
    while (*r.es > *r.ed && place < *s.ed) place += beat;
    while (*r.es < *r.ed && place > *s.ed) place -= beat;
  }
  anchors.push_back({*r.es, place});
  return anchors;
}

// Places where the beats of a render begin, the first at or before its first frame: phase 0 is an R
// wave. Beats may differ in length.
std::vector<double> beginsOf(const std::vector<double>& phases, double beat) {
  std::vector<double> begins;
  for (std::size_t i = 0; i + 1 < phases.size(); ++i) {
    const double turn = phases[i + 1] - phases[i], step = turn - std::floor(turn);
    if (begins.empty()) begins.push_back(step > 0 ? -phases[i] / step : 0);
    if (turn < 0) begins.push_back(static_cast<double>(i) + (1 - phases[i]) / step);
  }
  if (begins.empty()) begins.push_back(-phases.front() * beat);
  return begins;
}

// Empty where either side knows no R wave.
std::vector<Anchor> byRWaves(double synthetic_beat, double real_beat,
                             const echo::EchoLoop& synthetic, const echo::EchoLoop& real) {
  const std::vector<double> waves = real.rWaveFrames(), own = synthetic.rWaveFrames();
  std::vector<Anchor> anchors;
  if (waves.empty() || (synthetic.phases.empty() && own.empty()) || !(synthetic_beat > 0))
    return anchors;
  const std::vector<double> begins = synthetic.phases.empty()
                                         ? std::vector<double>{own.front()}
                                         : beginsOf(synthetic.phases, synthetic_beat);
  double beats = 0;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    if (i > 0) beats += echo::beatsBetween(waves[i] - waves[i - 1], real_beat);
    const auto whole = std::min(static_cast<std::size_t>(beats), begins.size() - 1);
    anchors.push_back(
        {waves[i], begins[whole] + (beats - static_cast<double>(whole)) * synthetic_beat});
  }
  return anchors;
}

TimeAlignment alignBy(const char* method, const TimeProblem& problem, std::vector<Anchor> anchors) {
  TimeAlignment t = alignByAnchors(problem, std::move(anchors));
  t.method = method;
  return t;
}

}  // namespace

TimeAlignment alignByWhatIsKnown(const CompareOptions& options, const TimeProblem& problem,
                                 const echo::EchoLoop& synthetic, const echo::EchoLoop& real) {
  // Frames of the synthetic side are checked even where they find no partner.
  const Cardinal s = cardinalOf(synthetic, options.synthetic_side);
  const Cardinal r{options.real_side.ed_frame, options.real_side.es_frame};
  if (r.ed || r.es) {
    cardinalOf(real, options.real_side);  // within the loop
    return alignBy("ED and ES frames as given", problem,
                   byMarks(s, r, problem.synthetic_beat, synthetic.video.name));
  }
  const std::vector<Anchor> waves =
      byRWaves(problem.synthetic_beat, problem.real_beat, synthetic, real);
  return waves.empty()
             ? alignInTime(problem)
             : alignBy(real.ecg ? "R waves of the ECG in the picture" : "R waves", problem, waves);
}

}  // namespace echocine::compare
