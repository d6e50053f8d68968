#include "fit/view_ranking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "core/nearest_word.h"
#include "fit/caveats.h"
#include "fit/cpu_seconds.h"
#include "fit/descent.h"
#include "fit/fit_progress.h"
#include "fit/option_list.h"

namespace echocine::fit {

namespace {

heart::View viewNamed(const std::string& name) {
  if (const auto view = heart::viewOf(name)) return *view;
  std::vector<std::string> known;
  std::string list;
  for (const heart::ViewName& v : heart::viewNames()) {
    known.emplace_back(v.key);
    list += std::string(v.key) + ", ";
  }
  const std::string nearest = nearestWord(name, known);
  throw SceneError(fmt::format("--views: \"{}\" is not a view{}, accepted: all, or some of {}",
                               name, nearest.empty() ? "" : fmt::format(" (nearest: {})", nearest),
                               list.substr(0, list.size() - 2)));
}

void checkViews(const std::vector<heart::View>& views) {
  if (views.size() < 2)
    throw SceneError(fmt::format("--views: has {}, needs two views or more", views.size()));
}

void noteLimits(ViewRanking& ranking) {
  const auto say = [&](const std::string& note) { ranking.notes.push_back(note); };
  const ViewFound& best = ranking.views.front();
  if (ranking.confidence < kLeastConfidence)
    say(fmt::format("{} and {} are hardly distinguishable (confidence {:.2f})", keyOf(best.view),
                    keyOf(ranking.views[1].view), ranking.confidence));
  if (best.beat.confidence < kLeastConfidence)
    say("the start of the beat is ambiguous: give the frame of end-diastole");
  if (best.heart.found.at_limit)
    say("the pose is at the limit of its search: a better one may lie beyond");
  if (best.heart.tilt && best.heart.tilt->at_limit)
    say("the tilt is at the limit of its search: a better one may lie beyond");
  for (std::size_t a = 0; a < ranking.population.size(); ++a) {
    const DialRange& range = ranking.population[a].range;
    const double value = best.heart.values[a], near = 1e-3 * (range.high - range.low);
    if (value <= range.low + near || value >= range.high - near)
      say(fmt::format("the minimum is at the end of {}: use --scan for a wider range", range.key));
  }
}

}  // namespace

ViewFound searchView(heart::View view, const HeartFamily& family,
                     const std::vector<ScanAxis>& population, const echo::EchoLoop& real,
                     const echo::SideOptions& side, double tilt_deg, const Monitor& monitor) {
  const ModelDiscrepancy discrepancy(real, side, family.at(middleOf(population)));
  ViewFound out;
  out.view = view;
  out.beat = discrepancy.beat();
  out.heart = searchHeart(family, population, discrepancy, tilt_deg, monitor);
  const PlaneTilt tilt = out.heart.tilt ? out.heart.tilt->tilt : PlaneTilt{};
  out.where = fitReport(family.at(out.heart.values, tilt), discrepancy, real, out.heart.found.pose);
  return out;
}

std::vector<heart::View> parseViews(const std::string& text) {
  std::vector<heart::View> views;
  if (text == "all") {
    for (const heart::ViewName& name : heart::viewNames())
      if (!isTransoesophageal(name.view)) views.push_back(name.view);
    return views;
  }
  for (const std::string& name : splitOption(text, ',')) {
    const heart::View view = viewNamed(name);
    if (std::find(views.begin(), views.end(), view) != views.end())
      throw SceneError(fmt::format("--views: {} is given twice", name));
    views.push_back(view);
  }
  if (views.size() < 2)
    throw SceneError(
        fmt::format("--views: {} alone has no rival; give two views or more, or all", text));
  return views;
}

void orderViews(ViewRanking& ranking) {
  std::stable_sort(
      ranking.views.begin(), ranking.views.end(),
      [](const ViewFound& a, const ViewFound& b) { return a.heart.left < b.heart.left; });
  CHECK_LE(std::size_t{2}, ranking.views.size());
  const double best = ranking.views[0].heart.left, next = ranking.views[1].heart.left;
  constexpr double kNothing = 1;
  ranking.margin = next - best;
  ranking.confidence = confidenceOf(best, next, kNothing);
}

ViewRanking rankViews(const echo::EchoLoop& real, const ViewsOptions& options,
                      const Monitor& monitor) {
  checkTilt(options.tilt_deg);
  checkViews(options.views);
  const double since = cpuSeconds();
  ViewRanking ranking;
  ranking.options = options;
  ranking.population = populationWithout(options.dials);
  ranking.beat_anchor = real.beat_anchor;
  std::vector<DialRange> ranges;
  for (const ScanAxis& axis : ranking.population) ranges.push_back(axis.range);
  const int nodes = nodesFor(ranges.size());
  const double making = kHeartUnits * std::pow(nodes, static_cast<double>(ranges.size()));
  FitProgress progress(monitor, making + kViewUnits * static_cast<double>(options.views.size()));
  const HeartNodes hearts(options.dials, ranges, kFitFrames, nodes, progress.next(making));
  ranking.nodes_ms = 1e3 * (cpuSeconds() - since);
  // One at a time: families are large.
  for (const heart::View view : options.views) {
    const Monitor one = progress.next(kViewUnits);
    ranking.views.push_back(searchView(view, HeartFamily(hearts, view, one, options.tilt_deg),
                                       ranking.population, real, options.side, options.tilt_deg,
                                       one));
  }
  progress.finish();
  orderViews(ranking);
  ranking.label = real.label;
  ranking.caveats = caveatsOf(real, ranking.views.front().beat, ranking.confidence);
  for (const std::string& note : real.video.notes) ranking.notes.push_back(note);
  noteLimits(ranking);
  ranking.cpu_ms = 1e3 * (cpuSeconds() - since);
  for (const std::string& note : ranking.notes) monitor.warn(note);
  return ranking;
}

ViewRanking rankViews(const ViewsOptions& options, const Monitor& monitor) {
  checkTilt(options.tilt_deg);
  checkViews(options.views);
  return rankViews(echo::readLoop(options.real, options.side, true), options, monitor);
}

}  // namespace echocine::fit
