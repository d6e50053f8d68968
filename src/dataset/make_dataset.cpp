// The page that shows how a dataset is made: draw -> heart -> loops -> layouts -> record, for every
// heart by itself; then the tables from the records.

#include "dataset/make_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "core/error.h"
#include "core/file.h"
#include "core/file_lock.h"
#include "core/out_of_memory.h"
#include "core/parallel.h"
#include "dataset/make_heart.h"
#include "dataset/record.h"
#include "dataset/tables.h"
#include "dataset/work_folder.h"

namespace echocine::dataset {

namespace {

struct Done {
  std::size_t loops = 0, bytes = 0, impossible = 0;
  bool kept = false, failed = false;
  std::string flaw = {};  // what was wrong with what an earlier run left
};

Done countsOf(const Json& record) {
  Done done;
  done.failed = isFailure(record);
  if (done.failed) return done;
  done.loops = record.at("loops").size();
  done.impossible = record.at("impossible").size();
  for (const auto& [name, mark] : record.at("files").items())
    done.bytes += mark.at("bytes").get<std::size_t>();
  return done;
}

// An impossible heart is recorded and the run continues; a failed write ends the run.
std::optional<Heart> tryHeart(const Spec& spec, int heart, const Monitor& monitor,
                              std::string& reason) {
  try {
    return makeHeart(spec, heart, monitor);
  } catch (const SceneError& error) {
    reason = error.what();
  } catch (const JobError& error) {
    if (!monitor.keep_going()) throw;
    reason = error.what();
  }
  return std::nullopt;
}

Done makeOne(const Spec& spec, int heart, const WorkFolder& work, const Monitor& monitor) {
  WorkFolder::Finished earlier = work.finished(heart, WorkFolder::Look::bytes);
  if (earlier.record && !isFailure(*earlier.record)) {
    Done done = countsOf(*earlier.record);
    done.kept = true;
    return done;
  }
  std::string reason;
  const std::optional<Heart> made = tryHeart(spec, heart, monitor, reason);
  if (!made) {
    work.finish(heart, failureOf(spec, heart, reason), {});
    return {.failed = true, .flaw = std::move(earlier.flaw)};
  }
  Json record = recordOf(spec, *made);
  Sink sink(work.folder());
  for (const Layout* layout : layoutsOf(spec))
    if (layout->write != nullptr) layout->write(spec, *made, sink, record);
  Done done;
  done.flaw = std::move(earlier.flaw);
  done.loops = made->loops.size();
  done.impossible = made->impossible.size();
  for (const auto& [name, mark] : sink.files()) done.bytes += mark.bytes;
  work.finish(heart, std::move(record), sink.files());
  return done;
}

void add(const Done& done, MakeSummary& summary) {
  summary.loops += done.loops;
  summary.bytes += done.bytes;
  summary.impossible += done.impossible;
  summary.kept += done.kept;
  summary.failed += done.failed;
}

// Keeps only those files of a finished heart that a layout's merge reads, to save memory.
void keepFiles(const Spec& spec, Json& record) {
  if (isFailure(record)) return;
  Json kept = Json::object();
  if (spec.has("webdataset"))
    for (const auto& [name, mark] : record.at("files").items())
      if (name.starts_with("native/")) kept[name] = mark;
  record["files"] = std::move(kept);
}

}  // namespace

MakeSummary makePart(const Spec& spec, const MakeOptions& options, const Monitor& monitor) {
  const WorkFolder work(options.folder, spec);
  const FileLock lock(options.folder / "work" /
                      fmt::format("task_{}_of_{}", options.task, options.tasks) / kLockName);
  MakeSummary summary;
  const auto first = static_cast<std::size_t>(options.task - 1),
             step = static_cast<std::size_t>(options.tasks),
             all = static_cast<std::size_t>(spec.hearts);
  const std::size_t count = first < all ? (all - first + step - 1) / step : 0;
  const auto make = [&](std::size_t i) -> std::shared_ptr<void> {
    const auto heart = static_cast<int>(first + i * step);
    try {
      return std::make_shared<Done>(makeOne(spec, heart, work, monitor));
    } catch (const std::bad_alloc&) {
      throw JobError(fmt::format("heart {}: {}", heart + 1, kOutOfMemory));
    }
  };
  const auto collect = [&](std::size_t i, std::shared_ptr<void> done) {
    lock.checkStillThere();
    const Done& one = *static_cast<Done*>(done.get());
    if (!one.flaw.empty())
      monitor.warn(fmt::format("heart {} was rendered again: {}", first + i * step + 1, one.flaw));
    add(one, summary);
    monitor.tell({Task::rendering, i + 1, count});
  };
  withThreads(options.threads, [&] {
    const auto in_flight = static_cast<std::size_t>(threadCount()) + 1;
    if (parallelOrdered(0, count, in_flight, monitor.keep_going, make, collect) < count)
      throw JobError("stopped: finished hearts are kept, the same command resumes");
  });
  return summary;
}

namespace {

constexpr std::size_t kShown = 20;  // of missing or damaged hearts

[[noreturn]] void failOfMissing(const std::vector<int>& missing, int hearts,
                                const std::string& first_flaw) {
  const std::size_t shown = std::min(kShown, missing.size());
  throw JobError(fmt::format(
      "{} of {} hearts are missing or damaged ({}{}){}{}: run the same command again without "
      "--merge",
      missing.size(), hearts,
      fmt::join(missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
      shown < missing.size() ? ", ..." : "", first_flaw.empty() ? "" : ", first ", first_flaw));
}

struct Records {
  std::vector<Json> finished, failed;
};

// The records of all hearts, in their order, and what they add up to. Throws JobError.
Records provenRecords(const Spec& spec, const WorkFolder& work, const MergeOptions& options,
                      const Monitor& monitor, MakeSummary& summary) {
  const auto look = options.fast ? WorkFolder::Look::sizes : WorkFolder::Look::bytes;
  const auto hearts = static_cast<std::size_t>(spec.hearts);
  Records records;
  std::vector<int> missing;
  std::size_t damaged = 0;
  std::string first_flaw;
  const auto prove = [&](std::size_t heart) -> std::shared_ptr<void> {
    return std::make_shared<WorkFolder::Finished>(work.finished(static_cast<int>(heart), look));
  };
  const auto collect = [&](std::size_t heart, std::shared_ptr<void> proven) {
    auto& [record, flaw] = *static_cast<WorkFolder::Finished*>(proven.get());
    if (!flaw.empty() && ++damaged <= kShown)
      monitor.warn(fmt::format("heart {}: {}", heart + 1, flaw));
    if (first_flaw.empty()) first_flaw = flaw;
    if (!record) return missing.push_back(static_cast<int>(heart) + 1);
    add(countsOf(*record), summary);
    keepFiles(spec, *record);
    (isFailure(*record) ? records.failed : records.finished).push_back(std::move(*record));
  };
  withThreads(options.threads, [&] {
    const auto in_flight = 2 * static_cast<std::size_t>(threadCount());
    if (parallelOrdered(0, hearts, in_flight, monitor.keep_going, prove, collect) < hearts)
      throw JobError("stopped: nothing was merged, repeat the command");
  });
  if (!missing.empty()) failOfMissing(missing, spec.hearts, first_flaw);
  return records;
}

// Into the card and dataset.json.
void addRealLoops(const WorkFolder& work, const MergeOptions& options, const Monitor& monitor,
                  std::span<const Json> records, DatasetFacts& facts) {
  withThreads(options.threads, [&] {
    const RealComparison comparison =
        compareWithReal(work.folder(), records, options.real, monitor);
    facts.real_loops = realLoopsText(comparison);
    facts.origin["real_loops"] = realLoopsJson(comparison);
  });
}

}  // namespace

MakeSummary mergeParts(const Spec& spec, const std::filesystem::path& folder,
                       const MergeOptions& options, const Monitor& monitor) {
  if (!options.real.empty()) checkRealLoops(spec, options.real);
  const WorkFolder work(folder, spec);
  const FileLock lock(folder / "work/merge" / kLockName);
  MakeSummary summary;
  const Records records = provenRecords(spec, work, options, monitor, summary);
  DatasetFacts facts = factsOf(spec);
  if (!options.real.empty()) addRealLoops(work, options, monitor, records.finished, facts);
  work.removeParts();
  Sink sink(folder);
  try {
    for (const Layout* layout : layoutsOf(spec))
      if (layout->merge != nullptr) layout->merge(spec, records.finished, sink);
    writeTables(facts, records.finished, records.failed, sink);
  } catch (const Json::exception&) {
    // A record with a sound digest that is not of this program: made by hand.
    throw JobError(
        fmt::format("{}: its records have another format than those of this program: delete the "
                    "folder's work/ and run the same command again",
                    folder.string()));
  }
  summary.merged = records.finished.size();
  if (records.finished.empty())
    throw JobError(fmt::format("all {} hearts failed, the first because of {}", spec.hearts,
                               records.failed.front().at("failed").get<std::string>()));
  return summary;
}

}  // namespace echocine::dataset
