// The page that shows the comparison: read -> common beam space -> beat -> time -> space -> greys
// -> metrics.

#include "compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compare/boundary_bands.h"
#include "compare/discrepancy.h"
#include "compare/motion_features.h"
#include "compare/view_search.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/shown_path.h"

namespace echocine::compare {

namespace {

// 200 beats a minute at a rate that is known; otherwise an eighth of the loop.
double shortestBeat(const Loop& loop) {
  constexpr double kShortest_s = 0.3;
  return loop.video.rate.trusted && loop.video.rate.hz > 0
             ? kShortest_s * loop.video.rate.hz
             : static_cast<double>(loop.video.frames.size()) / 8;
}

// What moves in a loop's own sector, whatever it is compared with. Features are coarse, so the grid
// may be.
Features ownFeatures(const Loop& loop) {
  BeamGrid grid = commonGrid(loop, loop);
  grid.lines = std::min(grid.lines, 128);
  grid.samples = std::min(grid.samples, 192);
  const BeamLoop beams = resample(grid, loop);
  return motionFeatures(grid, beams, areaWeights(grid, beams.valid, beams.valid));
}

BeatLength beatOf(const Loop& loop) {
  BeatLength beat = findBeatLength(ownFeatures(loop), shortestBeat(loop));
  const auto known = [&](double frames, const std::string& source) {
    beat.frames = frames;
    beat.confidence = 1;
    beat.source = source;
  };
  const Video& v = loop.video;
  if (loop.frames_per_beat > 0)
    known(loop.frames_per_beat, "manifest");
  else if (v.r_waves_s.size() > 1 && v.rate.hz > 0)
    known((v.r_waves_s.back() - v.r_waves_s.front()) / static_cast<double>(v.r_waves_s.size() - 1) *
              v.rate.hz,
          "R waves");
  else if (v.heart_rate_bpm && v.rate.trusted)
    known(60 / *v.heart_rate_bpm * v.rate.hz, v.heart_rate_source);
  return beat;
}

// End-diastole and end-systole of a render: the largest and smallest volume of the left ventricle's
// cavity, else of the structure that empties most.
struct Cardinal {
  std::optional<double> ed, es;
};

Cardinal fromVolumes(const Loop& loop) {
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

Cardinal cardinalOf(const Loop& loop, const SideOptions& side) {
  Cardinal c = fromVolumes(loop);
  if (side.ed_frame) c.ed = side.ed_frame;
  if (side.es_frame) c.es = side.es_frame;
  for (const auto& frame : {c.ed, c.es})
    if (frame && !(*frame >= 0 && *frame < loop.video.frameCount()))
      throw SceneError(fmt::format("{}: ED or ES frame {} is not in the loop, accepted: 0 to {}",
                                   loop.video.name, *frame, loop.video.frameCount() - 1));
  return c;
}

TimeAlignment timeOf(const CompareOptions& options, const TimeProblem& problem,
                     const Comparison& c) {
  const Cardinal s = cardinalOf(c.synthetic, options.synthetic_side);
  std::vector<Anchor> anchors;
  if (options.real_side.ed_frame || options.real_side.es_frame) {
    const Cardinal r{options.real_side.ed_frame, options.real_side.es_frame};
    cardinalOf(c.real, options.real_side);  // within the loop
    const auto missing = [&](const char* which) {
      throw SceneError(fmt::format("{}: its {} frame is not known; give --synthetic-{}",
                                   c.synthetic.video.name, which, which));
    };
    if (r.ed && !s.ed) missing("ed");
    if (r.es && !s.es) missing("es");
    if (r.ed) anchors.push_back({*r.ed, *s.ed});
    if (r.es) {
      double place = *s.es;
      if (r.ed && problem.synthetic_beat > 0) {  // after ED where the real one is, else before
        while (*r.es > *r.ed && place < *s.ed) place += problem.synthetic_beat;
        while (*r.es < *r.ed && place > *s.ed) place -= problem.synthetic_beat;
      }
      anchors.push_back({*r.es, place});
    }
    TimeAlignment t = alignByAnchors(problem, anchors);
    t.method = "ED and ES frames as given";
    return t;
  }
  const Video& v = c.real.video;
  const bool synthetic_r = !c.synthetic.phases.empty() || !c.synthetic.video.r_waves_s.empty();
  if (!v.r_waves_s.empty() && v.rate.hz > 0 && synthetic_r && problem.synthetic_beat > 0) {
    const double at_r = c.synthetic.phases.empty()
                            ? c.synthetic.video.r_waves_s.front() * c.synthetic.video.rate.hz
                            : -c.synthetic.phases.front() * problem.synthetic_beat;
    for (std::size_t i = 0; i < v.r_waves_s.size(); ++i)
      anchors.push_back(
          {v.r_waves_s[i] * v.rate.hz, at_r + static_cast<double>(i) * problem.synthetic_beat});
    TimeAlignment t = alignByAnchors(problem, anchors);
    t.method = "R waves";
    return t;
  }
  return alignInTime(problem);
}

// The synthetic loop at each real frame's instant; frames outside it are left as they are.
std::vector<float> pairedFrame(const Comparison& c, const BeamLoop& synthetic, std::size_t real) {
  return frameAtPlace(synthetic.frames, std::max(0.0, c.time.place[real]), c.synthetic_beat.frames,
                      c.time.periodic);
}

void pairInTime(const CompareOptions& options, Comparison& c) {
  const Features synthetic = motionFeatures(c.grid, c.synthetic_beams, c.weights),
                 real = motionFeatures(c.grid, c.real_beams, c.weights);
  const FrameRate &s = c.synthetic.video.rate, &r = c.real.video.rate;
  const TimeProblem problem{synthetic,
                            real,
                            c.synthetic_beat.frames,
                            c.real_beat.frames,
                            s.hz > 0 && r.hz > 0 ? s.hz / r.hz : 1,
                            c.real.video.repeats};
  c.time = timeOf(options, problem, c);
}

bool isCounted(const Comparison& c, std::size_t real) {
  return c.time.place[real] >= 0 && !c.real.video.isRepeat(static_cast<int>(real));
}

// Eq. 2 frame by frame, as the loops lie now; 0 where the synthetic one shows no such instant.
std::vector<double> discrepancies(const Comparison& c) {
  const WallEdges edges(c.grid, c.weights);
  std::vector<double> all(c.real_beams.frames.size(), 0);
  parallelBlocks(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      if (c.time.place[j] >= 0)
        all[j] = discrepancyOf(edgeCorrelation(edges(pairedFrame(c, c.synthetic_beams, j)),
                                               edges(c.real_beams.frames[j])),
                               c.share_in_sight);
  });
  return all;
}

double meanCounted(const Comparison& c, const std::vector<double>& values) {
  double sum = 0, n = 0;
  for (std::size_t j = 0; j < values.size(); ++j)
    if (isCounted(c, j)) sum += values[j], ++n;
  return n > 0 ? sum / n : 0;
}

// Where the real loop lies now, and what of it is common.
void place(const Placement& placement, Comparison& c) {
  const PixelPlane as_given = validSamples(c.grid, c.real, {});
  c.real_beams = resample(c.grid, c.real, placement);
  c.weights = areaWeights(c.grid, c.synthetic_beams.valid, c.real_beams.valid);
  c.share_in_sight = shareInSight(areaWeights(c.grid, c.synthetic_beams.valid, as_given), c.weights,
                                  placement.scale);
}

SpaceAlignment alignedFrom(const Placement& start, const Comparison& c) {
  // A dozen frames over the loop hold all there is to learn about four numbers.
  std::vector<int> frames;
  std::vector<std::vector<float>> paired;
  const std::size_t step = std::max<std::size_t>(1, c.real_beams.frames.size() / 12);
  for (std::size_t j = 0; j < c.real_beams.frames.size(); j += step)
    if (isCounted(c, j)) {
      frames.push_back(static_cast<int>(j));
      paired.push_back(pairedFrame(c, c.synthetic_beams, j));
    }
  if (frames.empty()) return {};
  return alignInSpace(c.grid, c.real, paired, frames, c.weights, start);
}

// Both loops stand in memory, resampled. Our choice: 2 GB, some 1300 frames of each.
void refuseTooLong(const Comparison& c) {
  constexpr double kMostBytes = 2e9;
  const auto frames =
      static_cast<double>(c.synthetic.video.frames.size() + c.real.video.frames.size());
  const double bytes = frames * static_cast<double>(c.grid.size()) * sizeof(float);
  if (bytes > kMostBytes)
    throw SceneError(fmt::format(
        "{} and {} have {} frames, which take {:.1f} GB in common beam "
        "space, accepted: {:.0f} GB; give a few beats of each",
        c.synthetic.video.name, c.real.video.name, frames, bytes * 1e-9, kMostBytes * 1e-9));
}

// Loops that resemble one another are registered by their greys; others first by where edges run.
void registerLoops(const CompareOptions& options, Comparison& c) {
  c.grid = commonGrid(c.synthetic, c.real);
  refuseTooLong(c);
  c.synthetic_beams = resample(c.grid, c.synthetic);
  place({}, c);
  if (std::count_if(c.weights.begin(), c.weights.end(), [](float w) { return w > 0; }) <
      static_cast<std::ptrdiff_t>(c.weights.size() / 10))
    throw SceneError(
        fmt::format("{} and {} share under a tenth of their sectors; give loops of the same view",
                    c.synthetic.video.name, c.real.video.name));
  c.synthetic_beat = beatOf(c.synthetic);
  c.real_beat = beatOf(c.real);
  pairInTime(options, c);
  c.discrepancy_as_placed = meanCounted(c, discrepancies(c));
  if (!options.align_space || c.discrepancy_as_placed == 0) return;
  const auto adopt = [&](const SpaceAlignment& found) {
    c.space = found;
    if (!found.used) return;
    place(found.placement, c);
    pairInTime(options, c);
  };
  const SpaceAlignment by_greys = alignedFrom({}, c);
  if (by_greys.used || by_greys.correlation_after > kAlikeCorrelation) return adopt(by_greys);
  adopt(searchView(c.grid, c.synthetic_beams, c.real));
  if (!c.space.used) return;
  if (const SpaceAlignment finer = alignedFrom(c.space.placement, c); finer.used) adopt(finer);
}

// The curve of the whole loop, from counted frames.
GreyCurve fitCurve(const CompareOptions& options, const std::vector<std::vector<float>>& synthetic,
                   const std::vector<std::vector<float>>& real, const Comparison& c) {
  std::vector<const std::vector<float>*> used;
  for (std::size_t j = 0; j < synthetic.size(); ++j)
    if (c.frames[j].counted()) used.push_back(&synthetic[j]);
  if (used.empty())
    throw SceneError(fmt::format("{} and {} share no instant of the beat; give longer loops",
                                 c.synthetic.video.name, c.real.video.name));
  CalibrationFit fit(options.knots.empty() ? quantileKnots(used, c.weights, options.knot_count)
                                           : options.knots);
  for (std::size_t j = 0; j < synthetic.size(); ++j)
    if (c.frames[j].counted()) fit.add(synthetic[j], real[j], c.weights);
  return fit.solve(options.monotone);
}

// Over counted frames.
FrameMetrics meanOf(const std::vector<FrameResult>& frames,
                    const std::function<const FrameMetrics&(const FrameResult&)>& pick) {
  std::vector<FrameMetrics> counted;
  for (const FrameResult& f : frames)
    if (f.counted()) counted.push_back(pick(f));
  return loopMetrics(counted);
}

void measureFrames(const std::vector<std::vector<float>>& paired, const BoundaryBands* bands,
                   Comparison& c) {
  parallelBlocks(c.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      FrameResult& f = c.frames[j];
      if (f.synthetic_place < 0) continue;
      const std::vector<float>& real = c.real_beams.frames[j];
      std::vector<float> fitted(paired[j].size());
      c.curve.apply(paired[j], fitted);
      f.before = frameMetrics({paired[j], real, c.weights, c.grid.lines, c.grid.samples});
      f.after = frameMetrics({fitted, real, c.weights, c.grid.lines, c.grid.samples});
      if (bands == nullptr) continue;
      for (const auto& [name, weights] : bands->weightsAt(f.synthetic_phase, c.weights))
        f.bands.push_back(
            {name, frameMetrics({fitted, real, weights, c.grid.lines, c.grid.samples})});
    }
  });
}

void summarise(Comparison& c) {
  c.mean_before =
      meanOf(c.frames, [](const FrameResult& f) -> const FrameMetrics& { return f.before; });
  c.mean_after =
      meanOf(c.frames, [](const FrameResult& f) -> const FrameMetrics& { return f.after; });
  const auto with_bands = std::find_if(c.frames.begin(), c.frames.end(),
                                       [](const FrameResult& f) { return !f.bands.empty(); });
  if (with_bands == c.frames.end()) return;
  for (std::size_t b = 0; b < with_bands->bands.size(); ++b)
    c.mean_bands.push_back({with_bands->bands[b].structure,
                            meanOf(c.frames, [b](const FrameResult& f) -> const FrameMetrics& {
                              static const FrameMetrics kNone;
                              return b < f.bands.size() ? f.bands[b].metrics : kNone;
                            })});
}

// Reading each loop, laying them on one another, calibrating, measuring.
class Steps {
 public:
  explicit Steps(const Monitor& monitor) : monitor_(monitor) {}
  // Throws JobError when the monitor wants to stop.
  void next() {
    if (!monitor_.keep_going()) throw JobError("stopped while loops were compared");
    monitor_.tell({Task::comparing, ++done_, kSteps});
  }

 private:
  static constexpr std::size_t kSteps = 5;
  const Monitor& monitor_;
  std::size_t done_ = 0;
};

// Loops of the same beat reach 0.3 and more. Our choice.
constexpr double kDoubtfulConfidence = 0.1;

void noteAssumptions(Comparison& c) {
  const auto say = [&](const std::string& note) { c.notes.push_back(note); };
  for (const Loop* loop : {&c.synthetic, &c.real})
    for (const std::string& note : loop->video.notes)
      say(shownName(loop->video.name) + ": " + note);
  if (!c.grid.metric)
    say(fmt::format(
        "{} has no length scale (--scale, in mm per pixel, gives it): both sectors are "
        "taken to be of "
        "one depth",
        shownName(c.real.metres_per_pixel ? c.synthetic.video.name : c.real.video.name)));
  for (const BeatLength* beat : {&c.synthetic_beat, &c.real_beat})
    if (beat->frames == 0)
      say(fmt::format(
          "{}: no beat found in the loop; frames are paired by the best shift and pace",
          shownName(beat == &c.real_beat ? c.real.video.name : c.synthetic.video.name)));
  if (c.time.confidence < kDoubtfulConfidence)
    say(
        fmt::format("the alignment in time is hardly better than any other (confidence {:.2f}): "
                    "--real-ed and --real-es, or R waves, say which frames belong together",
                    c.time.confidence));
  if (c.space.used && c.space.at_limit)
    say("the view that fits best lies at the limit of the search: a better one may lie beyond");
}

}  // namespace

Comparison compareLoops(const CompareOptions& options, const Monitor& monitor) {
  Steps steps(monitor);
  Comparison c;
  c.synthetic = readLoop(options.synthetic, options.synthetic_side, false);
  steps.next();
  c.real = readLoop(options.real, options.real_side, true);
  steps.next();
  std::optional<BoundaryBands> bands;
  registerLoops(options, c);
  steps.next();
  if (!options.scene.empty())
    bands.emplace(options.scene, c.synthetic, c.grid, 1e-3 * options.band_mm);
  noteAssumptions(c);
  for (const std::string& note : c.notes) monitor.warn(note);
  const std::vector<double> discrepancy = discrepancies(c);
  c.discrepancy = meanCounted(c, discrepancy);
  std::vector<std::vector<float>> paired;
  for (std::size_t j = 0; j < c.real_beams.frames.size(); ++j) {
    FrameResult f;
    f.discrepancy = discrepancy[j];
    f.real_frame = static_cast<int>(j);
    f.real_time_s = c.real.video.rate.hz > 0 ? static_cast<double>(j) / c.real.video.rate.hz : 0;
    f.synthetic_place = c.time.place[j];
    if (f.synthetic_place >= 0 && c.synthetic_beat.frames > 0) {
      const double phase = f.synthetic_place / c.synthetic_beat.frames +
                           (c.synthetic.phases.empty() ? 0 : c.synthetic.phases.front());
      f.synthetic_phase = phase - std::floor(phase);
    }
    f.repeat = c.real.video.isRepeat(f.real_frame);
    c.frames.push_back(f);
    paired.push_back(pairedFrame(c, c.synthetic_beams, j));
  }
  c.curve = fitCurve(options, paired, c.real_beams.frames, c);
  steps.next();
  measureFrames(paired, bands ? &*bands : nullptr, c);
  steps.next();
  summarise(c);
  return c;
}

}  // namespace echocine::compare
