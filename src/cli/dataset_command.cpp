#include "cli/dataset_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <chrono>

#include "cli/documents.h"
#include "cli/progress_bar.h"
#include "cli/stop_signal.h"
#include "core/error.h"
#include "dataset/make_dataset.h"

namespace echocine {

namespace {

using Clock = std::chrono::steady_clock;

// "3/7": the third of seven parts.
std::pair<int, int> parseTask(const std::string& text) {
  std::pair<int, int> task{0, 0};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, task.first);
  const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = slash ? std::from_chars(first.ptr + 1, end, task.second) : first;
  if (!slash || second.ec != std::errc() || second.ptr != end || task.first < 1 ||
      task.first > task.second)
    throw SceneError(fmt::format(
        "--task: \"{}\" is no part, accepted: K/N, the K-th of N parts, such as 1/8", text));
  return task;
}

}  // namespace

DatasetCommand::DatasetCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "dataset", "Make many loops with truth from a spec of distributions, in common layouts");
  command->add_option("spec", spec_file_, "Spec of the dataset (TOML)")->required();
  command->add_option("-o,--output", folder_, "Folder of the dataset; the same one goes on")
      ->required();
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  CLI::Option* task = command->add_option(
      "--task", task_, "Make only the K-th of N parts (K/N); tables wait for --merge");
  command->add_flag("--merge", merge_, "Make nothing: prove that all is there and write the tables")
      ->excludes(task);
  command->add_flag("--quiet", quiet_, "Print nothing but errors");
  command->footer("Example: echocine dataset examples/datasets/smoke.toml -o smoke\n" +
                  std::string(kDocuments));
}

int DatasetCommand::run() {
  listenForStop();
  const dataset::Spec spec = dataset::readSpec(spec_file_);
  dataset::MakeOptions options{folder_, threads_};
  if (!task_.empty()) std::tie(options.task, options.tasks) = parseTask(task_);
  if (!merge_) {
    ProgressBar bar(quiet_);
    const Clock::time_point start = Clock::now();
    Monitor monitor{.keep_going = [] { return !stopWanted(); }};
    monitor.tell = [&](const Progress& p) {
      if (!bar.due(p.done, p.total)) return;
      const double s = std::chrono::duration<double>(Clock::now() - start).count();
      const double rate = static_cast<double>(p.done * spec.views.size()) / s;
      bar.draw(p.done, p.total,
               fmt::format("{}/{} hearts, {:.2f} loops/s, {} left", p.done, p.total, rate,
                           minutesAndSeconds(s * static_cast<double>(p.total - p.done) /
                                             static_cast<double>(p.done))));
    };
    const dataset::MakeSummary made = dataset::makePart(spec, options, monitor);
    bar.finish();
    if (!quiet_)
      fmt::print("{} loops, {:.1f} MB; {} hearts were there before, {} failed, {} draws impossible\n",
                 made.loops, static_cast<double>(made.bytes) * 1e-6, made.kept, made.failed,
                 made.impossible);
    if (!task_.empty()) return 0;
  }
  const dataset::MakeSummary merged = dataset::mergeParts(spec, folder_);
  if (!quiet_)
    fmt::print("{} hearts, {} loops in {}: README.md tells of them\n", merged.merged, merged.loops,
               folder_.string());
  return 0;
}

}  // namespace echocine
