#include "fit/fit_files.h"

#include <fmt/format.h>

#include <deque>

#include "core/error.h"
#include "core/shown_path.h"
#include "core/stop.h"
#include "fit/caveats.h"
#include "fit/fit_results.h"
#include "output/heart_files.h"

namespace echocine::fit {

namespace {

namespace fs = std::filesystem;

// A folder within the output that is written once.
fs::path newHeart(const fs::path& folder) {
  const fs::path heart = folder / "heart";
  std::error_code error;
  if (fs::exists(heart, error))
    throw SceneError(fmt::format("{}: exists; remove it or give another folder", heart.string()));
  return heart;
}

// Views that are known before any loop is read; others stand for themselves.
void checkNamed(const std::vector<FitFile>& files) {
  if (files.empty() || files.size() > kMostLoops)
    return checkFitViews(std::vector<heart::View>(files.size()));
  std::vector<heart::View> named;
  for (const FitFile& file : files)
    if (file.view) named.push_back(*file.view);
  if (!named.empty()) checkFitViews(named);
}

heart::View rankedView(const FitFile& file, const echo::EchoLoop& loop,
                       const HeartFitOptions& options, const Monitor& monitor,
                       std::vector<std::string>& assumed) {
  ViewsOptions ranked;
  ranked.side = file.side;
  ranked.views = parseViews("all");
  ranked.dials = options.dials;
  // The dials of the ranking's population.
  for (const ScanAxis& axis : populationWithout({})) ranked.dials.erase(axis.range.key);
  const ViewRanking ranking = rankViews(loop, ranked, monitor);
  const heart::View view = clearView(shownName(loop.video.name), ranking);
  assumed.push_back(
      fmt::format("{}: ranked first with a confidence of {:.2f}", keyOf(view), ranking.confidence));
  return view;
}

}  // namespace

heart::View clearView(const std::string& file, const ViewRanking& ranking) {
  const heart::View best = ranking.views.front().view;
  if (ranking.confidence < kLeastConfidence)
    throw SceneError(
        fmt::format("{}: the view is unclear: {} with a confidence of {:.2f}, accepted: {:g} or "
                    "more; name it, such as {}=FILE",
                    file, keyOf(best), ranking.confidence, kLeastConfidence, keyOf(best)));
  return best;
}

FittedFiles fitFiles(const std::vector<FitFile>& files, const HeartFitOptions& options,
                     const std::optional<fs::path>& folder, const Monitor& monitor) {
  checkNamed(files);
  const fs::path heart = folder ? newHeart(*folder) : fs::path{};
  std::deque<echo::EchoLoop> read;
  std::vector<FitLoop> loops;
  std::vector<heart::View> views;
  std::vector<std::string> assumed;
  FittedFiles out;
  for (const FitFile& file : files) {
    read.push_back(echo::readLoop(file.file, file.side, true));
    views.push_back(file.view ? *file.view
                              : rankedView(file, read.back(), options, monitor, assumed));
    loops.push_back({views.back(), read.back(), file.side});
    out.labels.push_back(read.back().label);
  }
  out.fit = fitHeart(loops, options, monitor);
  out.fit.assumed = assumed;
  if (!folder) return out;
  // A stopped fit keeps its best heart.
  unstoppable([&] {
    if (out.fit.ef)
      writeHeart({.parameters = heart::parametersFrom(out.fit.dials), .view = views.front()},
                 heart);
    writeFit(out.fit, out.labels, *folder);
  });
  return out;
}

}  // namespace echocine::fit
