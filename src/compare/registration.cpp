#include "compare/registration.h"

#include <fmt/format.h>

#include <algorithm>

#include "compare/frame_discrepancy.h"
#include "compare/space_alignment.h"
#include "compare/time_anchors.h"
#include "core/error.h"
#include "core/parallel.h"
#include "echo/frame_blend.h"
#include "echo/motion_features.h"

namespace echocine::compare {

namespace {

void pairInTime(const CompareOptions& options, Comparison& c) {
  const echo::Features synthetic = echo::motionFeatures(c.grid, c.synthetic_beams, c.weights),
                       real = echo::motionFeatures(c.grid, c.real_beams, c.weights);
  const FrameRate &s = c.synthetic.video.rate, &r = c.real.video.rate;
  const TimeProblem problem{synthetic,
                            real,
                            c.synthetic_beat.frames,
                            c.real_beat.frames,
                            s.hz > 0 && r.hz > 0 ? s.hz / r.hz : 1,
                            c.real.video.repeats};
  c.time = alignByWhatIsKnown(options, problem, c.synthetic, c.real);
}

bool isCounted(const Comparison& c, std::size_t real) {
  return c.time.place[real] >= 0 && !c.real.video.isRepeat(static_cast<int>(real));
}

// Where the real loop lies now, and what of it is common.
void place(const echo::Placement& placement, Comparison& c) {
  const PixelPlane as_given = echo::validSamples(c.grid, c.real, {});
  c.real_beams = echo::resample(c.grid, c.real, placement);
  c.weights = echo::areaWeights(c.grid, c.synthetic_beams.valid, c.real_beams.valid);
  c.overlap = overlapShare(echo::areaWeights(c.grid, c.synthetic_beams.valid, as_given), c.weights,
                           placement.scale);
}

std::vector<float> pairedFrame(const Comparison& c, const std::vector<std::vector<float>>& frames,
                               std::size_t real) {
  return echo::frameAtPlace(frames, std::max(0.0, c.time.place[real]), c.synthetic_beat.frames,
                            c.time.periodic);
}

// Limit for both loops in memory, resampled. Our choice: 2 GB, some 1300 frames of each.
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

}  // namespace

std::vector<float> pairedFrame(const Comparison& c, std::size_t real) {
  return pairedFrame(c, c.synthetic_beams.frames, real);
}

std::vector<double> discrepancies(const Comparison& c) {
  const WallEdges edges(c.grid, c.weights);
  std::vector<double> all(c.real_beams.frames.size(), 0);
  parallelBlocks(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j)
      if (c.time.place[j] >= 0)
        all[j] = discrepancyOf(
            edgeCorrelation(edges(pairedFrame(c, j)), edges(c.real_beams.frames[j])), c.overlap);
  });
  return all;
}

double meanCounted(const Comparison& c, const std::vector<double>& values) {
  double sum = 0, n = 0;
  for (std::size_t j = 0; j < values.size(); ++j)
    if (isCounted(c, j)) sum += values[j], ++n;
  return n > 0 ? sum / n : 0;
}

void registerLoops(const CompareOptions& options, Comparison& c) {
  c.grid = echo::commonGrid(c.synthetic, c.real);
  refuseTooLong(c);
  c.synthetic_beams = echo::resample(c.grid, c.synthetic);
  place({}, c);
  if (std::count_if(c.weights.begin(), c.weights.end(), [](float w) { return w > 0; }) <
      static_cast<std::ptrdiff_t>(c.weights.size() / 10))
    throw SceneError(
        fmt::format("{} and {} share under a tenth of their sectors; give loops of the same view",
                    c.synthetic.video.name, c.real.video.name));
  c.synthetic_beat = echo::beatOf(c.synthetic);
  c.real_beat = echo::beatOf(c.real);
  pairInTime(options, c);
  c.discrepancy_as_placed = meanCounted(c, discrepancies(c));
  if (!options.align_space) return;
  // Which instants belong together depends on where the loops lie: each start has its own.
  const SpaceSearch search(c.grid, c.synthetic, c.real);
  std::vector<fit::Descent> refined;
  for (const fit::Unknowns& start : search.starts()) {
    place(search.placementAt(start), c);
    pairInTime(options, c);
    refined.push_back(search.refined(start, [&](const auto& frames, std::size_t real) {
      return isCounted(c, real) ? pairedFrame(c, frames, real) : std::vector<float>{};
    }));
  }
  c.space = search.best(refined);
  place(c.space.placement, c);
  pairInTime(options, c);
}

}  // namespace echocine::compare
