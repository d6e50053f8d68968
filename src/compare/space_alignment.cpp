#include "compare/space_alignment.h"

#include <algorithm>
#include <cmath>

#include "compare/frame_discrepancy.h"
#include "core/parallel.h"
#include "core/units.h"

namespace echocine::compare {

namespace {

// Units of Unknowns: 2 mm in 15 cm, in parts of the outer radius.
constexpr double kShiftPart = 2.0 / 150, kScalePart = 0.03;
const double kTurnPart_rad = radiansFromDegrees(2);

// Smoothed by 2 % of the depth, greys need no finer grid.
echo::BeamGrid coarser(echo::BeamGrid grid) {
  constexpr int kMost = 96;
  grid.lines = std::min(grid.lines, kMost);
  grid.samples = std::min(grid.samples, kMost);
  return grid;
}

// Its outermost pixels show none: a place beyond the picture is carried on from there.
std::vector<float> insideOf(const echo::EchoLoop& loop) {
  const int w = loop.video.width, h = loop.video.height;
  std::vector<float> inside;
  inside.reserve(loop.overlay.size());
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const bool border = x == 0 || y == 0 || x == w - 1 || y == h - 1;
      inside.push_back(!border && echo::showsEcho(loop, x + 0.5, y + 0.5) ? 1.0f : 0.0f);
    }
  return inside;
}

}  // namespace

SpaceSearch::SpaceSearch(const echo::BeamGrid& grid, const echo::EchoLoop& synthetic,
                         const echo::EchoLoop& real)
    : grid_(coarser(grid)),
      real_(real),
      sampler_(grid_, real),
      synthetic_(echo::resample(grid_, synthetic)),
      inside_(insideOf(real)) {
  as_given_ = weightsAt(sampler_.placesInLoop({}));
  // A dozen frames over the loop hold all there is to learn about four numbers.
  const std::size_t all = real.video.frames.size(), step = std::max<std::size_t>(1, all / 12);
  for (std::size_t j = 0; j < all; j += step)
    if (!real.video.isRepeat(static_cast<int>(j))) frames_.push_back(j);
  pictures_.resize(frames_.size());
  parallelBlocks(frames_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) pictures_[i] = sampler_.picture(frames_[i]);
  });
}

echo::Placement SpaceSearch::placementAt(const fit::Unknowns& at) const {
  const double radius = real_.sector().r_max;
  return {kShiftPart * radius * at[0], kShiftPart * radius * at[1], 1 + kScalePart * at[3],
          kTurnPart_rad * at[2]};
}

fit::SearchBox SpaceSearch::box() const {
  fit::SearchBox box;
  box.high = {kMostShift / kShiftPart, kMostShift / kShiftPart,
              radiansFromDegrees(kMostTurn_deg) / kTurnPart_rad,
              grid_.metric ? 0 : kMostScaling / kScalePart};
  for (std::size_t u = 0; u < fit::kUnknowns; ++u) box.low[u] = -box.high[u];
  return box;
}

std::vector<float> SpaceSearch::weightsAt(const std::vector<echo::PixelPlace>& in_loop) const {
  std::vector<float> weights = echo::areaWeights(grid_, synthetic_.valid, synthetic_.valid);
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (weights[i] > 0) weights[i] *= echo::greyAt(inside_.data(), real_.video.width, in_loop[i]);
  return weights;
}

double SpaceSearch::unlikeAt(const std::vector<Pair>& pairs, const fit::Unknowns& at) const {
  const echo::Placement placement = placementAt(at);
  const std::vector<echo::PixelPlace> in_loop = sampler_.placesInLoop(placement),
                                      places = real_.traced.frames.empty()
                                                   ? in_loop
                                                   : sampler_.places(placement);
  const std::vector<float> weights = weightsAt(in_loop);
  const double share = overlapShare(as_given_, weights, placement.scale);
  if (!(share > 0)) return 2;
  const WallEdges edges(grid_, weights);
  std::vector<float> placed(places.size());
  double sum = 0;
  for (const Pair& pair : pairs) {
    for (std::size_t i = 0; i < places.size(); ++i)
      placed[i] = echo::greyAt(pair.real->data(), sampler_.width(), places[i]);
    sum += edgeCorrelation(edges(pair.synthetic), edges(placed));
  }
  return (1 - sum / static_cast<double>(pairs.size())) / share;
}

std::vector<fit::Unknowns> SpaceSearch::starts() const {
  const std::vector<float> real = sampler_.meanPicture();
  const std::vector<Pair> means{{echo::meanOf(synthetic_.frames), &real}};
  const fit::PoseFunction value =
      fit::oneByOne([&](const fit::Unknowns& at) { return unlikeAt(means, at); });
  constexpr std::size_t kStarts = 5;
  std::vector<fit::Descent> from = fit::leastApart(lattice(value, box(), {4, 4, 2, 2}), kStarts);
  from.push_back({fit::Unknowns{}, 2});
  std::vector<fit::Unknowns> out;
  for (const fit::Descent& d : fit::leastApart(fit::descendAll(value, from, box()), from.size()))
    out.push_back(d.at);
  return out;
}

fit::Descent SpaceSearch::refined(const fit::Unknowns& start, const Pairing& synthetic_at) const {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    Pair pair{synthetic_at(synthetic_.frames, frames_[i]), &pictures_[i]};
    if (!pair.synthetic.empty()) pairs.push_back(std::move(pair));
  }
  if (pairs.empty()) return {start, 1};
  return fit::descend(fit::oneByOne([&](const fit::Unknowns& at) { return unlikeAt(pairs, at); }),
                      start, box());
}

SpaceAlignment SpaceSearch::best(const std::vector<fit::Descent>& refined) const {
  const std::vector<fit::Descent> hills = fit::leastApart(refined, refined.size());
  SpaceAlignment out;
  const fit::Unknowns& at = hills.front().at;
  out.placement = placementAt(at);
  out.used = std::any_of(at.begin(), at.end(), [](double u) { return u != 0; });
  out.method = "several starts, then Newton's method";
  out.at_limit = box().atLimit(at);
  out.unlike = hills.front().value;
  for (std::size_t i = 1; i < hills.size(); ++i)
    out.rivals.push_back({placementAt(hills[i].at), hills[i].value});
  constexpr double kNothing = 1;  // E of unrelated loops
  out.confidence = fit::confidenceOf(
      out.unlike, out.rivals.empty() ? kNothing : out.rivals.front().unlike, kNothing);
  return out;
}

}  // namespace echocine::compare
