// The page that shows how a dataset is made: draw -> heart -> loops -> layouts -> record, for every
// heart by itself; then the tables from the records.

#include "dataset/make_dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "core/error.h"
#include "core/file.h"
#include "core/folder_lock.h"
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
};

Done countsOf(const Json& record) {
  Done done;
  done.failed = isFailure(record);
  if (done.failed) return done;
  done.loops = record["loops"].size();
  done.impossible = record["impossible"].size();
  for (const auto& [name, mark] : record["files"].items())
    done.bytes += mark["bytes"].get<std::size_t>();
  return done;
}

// What cannot be made is noted and the rest goes on; what cannot be written ends the run.
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
  if (const auto record = work.finished(heart, WorkFolder::Look::bytes);
      record && !isFailure(*record)) {
    Done done = countsOf(*record);
    done.kept = true;
    return done;
  }
  std::string reason;
  const std::optional<Heart> made = tryHeart(spec, heart, monitor, reason);
  if (!made) {
    work.finish(heart, failureOf(spec, heart, reason), {});
    return {.failed = true};
  }
  Json record = recordOf(spec, *made);
  Sink sink(work.folder());
  for (const Layout* layout : layoutsOf(spec))
    if (layout->write != nullptr) layout->write(spec, *made, sink, record);
  Done done;
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

// Of a finished heart's files, those that a layout's merge reads: of many hearts they are many.
void keepFiles(const Spec& spec, Json& record) {
  if (isFailure(record)) return;
  Json kept = Json::object();
  if (spec.has("webdataset"))
    for (const auto& [name, mark] : record["files"].items())
      if (name.starts_with("native/")) kept[name] = mark;
  record["files"] = std::move(kept);
}

}  // namespace

MakeSummary makePart(const Spec& spec, const MakeOptions& options, const Monitor& monitor) {
  const WorkFolder work(options.folder, spec);
  const std::filesystem::path own =
      options.folder / "work" / fmt::format("task_{}_of_{}", options.task, options.tasks);
  makeFolder(own);
  const FolderLock lock(own);
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
    add(*static_cast<Done*>(done.get()), summary);
    monitor.tell({Task::rendering, i + 1, count});
  };
  withThreads(options.threads, [&] {
    const auto in_flight = static_cast<std::size_t>(threadCount()) + 1;
    if (parallelOrdered(0, count, in_flight, monitor.keep_going, make, collect) < count)
      throw JobError("stopped: finished hearts are kept, the same command goes on");
  });
  return summary;
}

MakeSummary mergeParts(const Spec& spec, const std::filesystem::path& folder) {
  const WorkFolder work(folder, spec);
  std::vector<Json> records, failures;
  std::vector<int> missing;
  MakeSummary summary;
  for (int heart = 0; heart < spec.hearts; ++heart) {
    std::optional<Json> record = work.finished(heart, WorkFolder::Look::sizes);
    if (!record) {
      missing.push_back(heart + 1);
      continue;
    }
    add(countsOf(*record), summary);
    keepFiles(spec, *record);
    (isFailure(*record) ? failures : records).push_back(std::move(*record));
  }
  if (!missing.empty()) {
    constexpr std::size_t kShown = 20;
    const std::size_t shown = std::min(kShown, missing.size());
    throw JobError(fmt::format(
        "{} of {} hearts are missing or damaged ({}{}): run the same command again without --merge",
        missing.size(), spec.hearts,
        fmt::join(missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
        shown < missing.size() ? ", ..." : ""));
  }
  Sink sink(folder);
  for (const Layout* layout : layoutsOf(spec))
    if (layout->merge != nullptr) layout->merge(spec, records, sink);
  writeTables(spec, records, failures, sink);
  summary.merged = records.size();
  return summary;
}

}  // namespace echocine::dataset
