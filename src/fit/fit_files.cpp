#include "fit/fit_files.h"

#include <fmt/format.h>

#include <deque>

#include "core/digest.h"
#include "core/error.h"
#include "core/output_check.h"
#include "core/shown_path.h"
#include "core/stop.h"
#include "fit/caveats.h"
#include "fit/fit_results.h"
#include "fit/packed_bytes.h"
#include "fit/results_folder.h"
#include "output/heart_files.h"

namespace echocine::fit {

namespace {

namespace fs = std::filesystem;

constexpr const char* kJournal = "fit.journal";

// A folder within the output that is written once; that of a stopped fit is replaced. The journal
// of a fit that was stopped or killed is continued, never removed.
fs::path newHeart(const fs::path& folder, bool resume) {
  const fs::path heart = folder / "heart", journal = folder / kJournal;
  std::error_code error;
  if (fs::exists(journal, error)) {
    if (!resume)
      throw SceneError(fmt::format(
          "{}: is of a stopped fit; give --resume (resume), remove it or give another folder",
          journal.string()));
    return heart;
  }
  if (fs::exists(heart, error))
    throw SceneError(fmt::format("{}: exists; remove it or give another folder", heart.string()));
  return heart;
}

// Everything that evaluations depend on.
std::string digestOf(const std::vector<FitLoop>& loops, const HeartFitOptions& options) {
  PackedBytes all;
  all.putText(ownProgramDigest());
  for (const auto& [key, value] : options.dials) {
    all.putText(key);
    all.put(value);
  }
  for (const std::string& key : options.searched.value_or(std::vector<std::string>{}))
    all.putText(key);
  all.put(options.tilt_deg);
  all.put(options.starts);
  all.put(options.descents);
  all.put(options.own_loops);
  all.put(options.ownLook(loops.size()));
  all.put(options.own_look.has_value());
  all.put(options.settling_steps);
  all.put(options.resamples);
  all.put(options.other_views);
  for (const FitLoop& one : loops) {
    const echo::EchoLoop& loop = one.loop;
    all.put(one.view);
    all.put(one.side.ed_frame.value_or(-1));
    all.put(one.side.es_frame.value_or(-1));
    all.put(loop.video.width);
    all.put(loop.video.rate.hz);
    all.put(loop.metres_per_pixel.value_or(-1));
    all.put(loop.frames_per_beat);
    all.putAll(loop.rWaveFrames());
    const echo::Sector& s = loop.sector();
    for (const double number : {s.apex_x, s.apex_y, s.first_rad, s.last_rad, s.r_min, s.r_max})
      all.put(number);
    for (const PixelPlane& frame : loop.video.frames) all.putAll(frame);
    all.putAll(loop.overlay);
  }
  return digestOfBytes(all.all());
}

void writeFound(const FittedFiles& made, heart::View view, const fs::path& folder,
                const fs::path& heart) {
  const ResultsFolder emptied(folder, kFitFiles);  // a stopped fit's results are of another heart
  std::error_code error;
  fs::remove_all(heart, error);  // newHeart() found none, or that of a stopped fit
  if (made.fit.ef)
    writeHeart({.parameters = heart::parametersFrom(made.fit.dials), .view = view}, heart);
  writeFit(made.fit, made.labels, folder);
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
                     const std::optional<fs::path>& folder, const Monitor& monitor, bool resume) {
  checkNamed(files);
  checkFitOptions(options);
  const fs::path heart = folder ? newHeart(*folder, resume) : fs::path{};
  if (folder) checkOutputFolder(*folder, {"fit.json", "fit.html", "curves.csv"});
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
  HeartFitOptions kept = options;
  kept.journal.reset();
  if (folder)
    kept.journal = std::make_shared<FitJournal>(*folder / kJournal, digestOf(loops, options));
  out.fit = fitHeart(loops, kept, monitor);
  out.fit.assumed.insert(out.fit.assumed.begin(), assumed.begin(), assumed.end());
  if (!folder) return out;
  // A stopped fit keeps its best heart.
  unstoppable([&] {
    writeFound(out, views.front(), *folder, heart);
    if (!out.fit.stopped) kept.journal->finish();
  });
  return out;
}

}  // namespace echocine::fit
