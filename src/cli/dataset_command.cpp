#include "cli/dataset_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <chrono>

#include "cli/documents.h"
#include "cli/progress_bar.h"
#include "cli/stop_signal.h"
#include "cli/warning_printer.h"
#include "core/error.h"
#include "core/run_script.h"
#include "core/stop.h"
#include "dataset/heart_cost.h"
#include "dataset/make_dataset.h"
#include "dataset/preview.h"
#include "dataset/slurm.h"

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
  command
      ->add_option("-o,--output", folder_,
                   "Folder of the dataset, the same one goes on; of --preview the page")
      ->required();
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  CLI::Option* task = command->add_option(
      "--task", task_, "Make only the K-th of N parts (K/N); tables wait for --merge");
  CLI::Option* merge = command
                           ->add_flag("--merge", merge_,
                                      "Make nothing: prove that all is there and write the tables")
                           ->excludes(task);
  command
      ->add_flag("--fast", fast_,
                 "Of --merge: prove files by their sizes alone, not by their bytes")
      ->needs(merge);
  command
      ->add_option(
          "--preview", preview_,
          "Write only a page and a contact sheet of N hearts, with time and disk of the whole")
      ->check(CLI::Range(1, 1000))
      ->excludes(task)
      ->excludes(merge);
  CLI::Option* slurm = command
                           ->add_flag("--slurm", slurm_,
                                      "Write jobs of Slurm into FOLDER/slurm and submit them: an "
                                      "array, and a merge behind it")
                           ->excludes(task)
                           ->excludes(merge)
                           ->excludes("--preview");
  command->add_flag("--no-submit", no_submit_, "Of --slurm: write the jobs only")->needs(slurm);
  command
      ->add_option(
          "--tasks", tasks_,
          "Of --slurm: tasks of the array; default: of about half an hour, by the first heart")
      ->check(CLI::Range(1, 1000000))
      ->needs(slurm);
  command->add_option("--cores", cores_, "Of --slurm: cores of a task; default 4")
      ->check(CLI::Range(1, 4096))
      ->needs(slurm);
  command
      ->add_option("--minutes", minutes_,
                   "Of --slurm: a task's limit; default: three times what the first heart tells")
      ->check(CLI::Range(1, 1000000))
      ->needs(slurm);
  command
      ->add_option("--sbatch", sbatch_,
                   "Of --slurm: more options for sbatch, such as \"--partition=cpu\"")
      ->needs(slurm);
  command->add_flag("--quiet", quiet_, "Print nothing but errors");
  command->footer("Example: echocine dataset examples/datasets/smoke.toml -o smoke\n" +
                  std::string(kDocuments));
}

int DatasetCommand::run() {
  try {
    return make();
  } catch (const Stopped&) {
    throw JobError("stopped: finished hearts are kept, the same command goes on");
  }
}

int DatasetCommand::make() {
  const dataset::Spec spec = dataset::readSpec(spec_file_);
  if (preview_ > 0) return preview(spec);
  if (slurm_) return slurm(spec);
  dataset::MakeOptions options{folder_, threads_};
  if (!task_.empty()) std::tie(options.task, options.tasks) = parseTask(task_);
  if (!merge_) {
    ProgressBar bar(quiet_);
    const Clock::time_point start = Clock::now();
    Monitor monitor{.keep_going = [] { return !stopWanted(); }, .warn = warningPrinter(quiet_)};
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
      fmt::print(
          "{} loops, {:.1f} MB; {} hearts were there before, {} failed, {} draws impossible\n",
          made.loops, static_cast<double>(made.bytes) * 1e-6, made.kept, made.failed,
          made.impossible);
    if (!task_.empty()) return 0;
  }
  // A run without --merge has just proven the bytes of what it kept.
  const dataset::MakeSummary merged = dataset::mergeParts(
      spec, folder_, {.fast = fast_ || !merge_, .threads = threads_},
      {.keep_going = [] { return !stopWanted(); }, .warn = warningPrinter(quiet_)});
  if (!quiet_)
    fmt::print("{} hearts, {} loops in {}: README.md tells of them\n", merged.merged, merged.loops,
               folder_.string());
  return 0;
}

int DatasetCommand::preview(const dataset::Spec& spec) const {
  if (folder_.extension() != ".html")
    throw SceneError(fmt::format(
        "--output: \"{}\" is no page, accepted with --preview: a name that ends in .html",
        folder_.string()));
  ProgressBar bar(quiet_);
  Monitor monitor{.keep_going = [] { return !stopWanted(); }};
  monitor.tell = [&](const Progress& p) {
    if (bar.due(p.done, p.total))
      bar.draw(p.done, p.total, fmt::format("{}/{} hearts", p.done, p.total));
  };
  const dataset::PreviewSummary made =
      dataset::writePreview(spec, folder_, preview_, threads_, monitor);
  bar.finish();
  if (!quiet_)
    fmt::print("{}: {} hearts; all {} loops take about {} and {:.1f} MB\n", folder_.string(),
               made.pictures, spec.loops(), minutesAndSeconds(made.seconds), made.bytes * 1e-6);
  return 0;
}

int DatasetCommand::slurm(const dataset::Spec& spec) const {
  dataset::SlurmOptions options;
  options.program = std::filesystem::read_symlink("/proc/self/exe");
  options.folder = folder_;
  options.cores = cores_;
  options.more = sbatch_;
  options.tasks = tasks_;
  options.minutes = minutes_;
  if (tasks_ == 0 || minutes_ == 0) {
    const double heart_s =
        dataset::costOfAHeart(spec, folder_, {.keep_going = [] { return !stopWanted(); }}).seconds;
    if (tasks_ == 0) options.tasks = dataset::slurmTasks(spec.hearts, heart_s, cores_);
    if (minutes_ == 0)
      options.minutes = dataset::slurmMinutes(spec.hearts, heart_s, cores_, options.tasks);
  }
  options.tasks = std::min(options.tasks, spec.hearts);
  const std::filesystem::path submit = dataset::writeSlurmJobs(spec, options);
  if (!quiet_)
    fmt::print("{}: {} tasks of {} cores and at most {} minutes, then a merge\n",
               submit.parent_path().string(), options.tasks, options.cores, options.minutes);
  std::fflush(stdout);
  if (!no_submit_ && !runScript(submit))
    throw JobError(fmt::format("{}: submitting failed; the jobs are written: submit them with it",
                               submit.string()));
  return 0;
}

}  // namespace echocine
