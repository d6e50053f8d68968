#include "cli/dataset_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <chrono>

#include "cli/dataset_arguments.h"
#include "cli/documents.h"
#include "cli/progress_bar.h"
#include "cli/stop_signal.h"
#include "cli/warning_printer.h"
#include "core/error.h"
#include "core/run_script.h"
#include "core/stop.h"
#include "dataset/folder_spec.h"
#include "dataset/growth.h"
#include "dataset/heart_cost.h"
#include "dataset/join.h"
#include "dataset/make_dataset.h"
#include "dataset/preview.h"
#include "dataset/slurm.h"
#include "dataset/status.h"
#include "dataset/work_folder.h"

namespace echocine {

namespace {

using Clock = std::chrono::steady_clock;

Monitor countingHearts(ProgressBar& bar, bool quiet) {
  const auto tell = [&bar](const Progress& p) {
    if (bar.due(p.done, p.total))
      bar.draw(p.done, p.total, fmt::format("{}/{} hearts", p.done, p.total));
  };
  return {tell, [] { return !stopWanted(); }, warningPrinter(quiet)};
}

void printMade(std::size_t hearts, std::size_t loops, const std::filesystem::path& folder) {
  fmt::print("{} hearts, {} loops in {}: README.md describes them\n", hearts, loops,
             folder.string());
}

}  // namespace

DatasetCommand::DatasetCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "dataset",
      "Generate many loops with ground truth from a spec of distributions, in common layouts");
  command->add_option("spec", spec_file_,
                      "Spec of the dataset (TOML); default: the spec in the folder");
  command->add_option(
      "-o,--output", folder_,
      "Folder of the dataset; an existing one is resumed. With --preview: the page to write");
  CLI::Option* state =
      command->add_option("--status", status_, "Print the state of a dataset's folder");
  CLI::Option* difference = command->add_option(
      "--diff", other_spec_, "Print the keys that differ from another spec or folder");
  CLI::Option* joining =
      command
          ->add_option("--join", joined_,
                       "Join the finished datasets in these folders into the folder of --output")
          ->expected(2, 1000);
  command
      ->add_option("--name", join_name_,
                   "With --join: name of the joined dataset; default: the names of its parts")
      ->needs(joining);
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  CLI::Option* task = command->add_option(
      "--task", task_, "Render only the K-th of N parts (K/N); --merge writes the tables");
  CLI::Option* merge =
      command
          ->add_flag("--merge", merge_,
                     "Render nothing: verify that all parts exist and write the tables")
          ->excludes(task);
  command->add_flag("--fast", fast_, "With --merge: verify files by size only, not by content")
      ->needs(merge);
  command
      ->add_option("--real", real_,
                   "With --merge: real loops and their mm per pixel (FILE=MM); the dataset's card "
                   "states how well a linear classifier distinguishes the dataset from them")
      ->expected(1, 1000)
      ->needs(merge);
  command
      ->add_option("--preview", preview_,
                   "Write only a page and a contact sheet of N hearts, with the expected time and "
                   "disk space")
      ->check(CLI::Range(1, 1000))
      ->excludes(task)
      ->excludes(merge);
  CLI::Option* slurm =
      command
          ->add_flag("--slurm", slurm_,
                     "Write Slurm jobs into FOLDER/slurm and submit them: an array, then a merge")
          ->excludes(task)
          ->excludes(merge)
          ->excludes("--preview");
  command->add_flag("--no-submit", no_submit_, "With --slurm: write the jobs only")->needs(slurm);
  command
      ->add_option(
          "--tasks", tasks_,
          "With --slurm: number of tasks of the array; by default a task takes about half an hour")
      ->check(CLI::Range(1, 1000000))
      ->needs(slurm);
  command->add_option("--cores", cores_, "With --slurm: cores per task; default 4")
      ->check(CLI::Range(1, 4096))
      ->needs(slurm);
  command
      ->add_option("--minutes", minutes_,
                   "With --slurm: time limit of a task; default: three times the estimate from the "
                   "first heart")
      ->check(CLI::Range(1, 1000000))
      ->needs(slurm);
  command
      ->add_option("--sbatch", sbatch_,
                   "With --slurm: more options for sbatch, such as \"--partition=cpu\"")
      ->needs(slurm);
  difference->excludes(state);
  joining->excludes(state)->excludes(difference)->excludes("spec")->excludes("--threads");
  state->excludes("spec")->excludes("--output")->excludes("--threads");
  for (CLI::Option* other : {state, difference, joining})
    other->excludes(task)->excludes(merge)->excludes("--preview")->excludes(slurm);
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine dataset examples/datasets/smoke.toml -o smoke\n" +
                  std::string(kDocuments));
}

int DatasetCommand::run() {
  try {
    return make();
  } catch (const Stopped&) {
    if (preview_ > 0) throw JobError("stopped: no preview was written");
    if (slurm_) throw JobError("stopped: no jobs were written");
    if (!joined_.empty()) throw JobError("stopped: the same command resumes");
    throw JobError("stopped: finished hearts are kept, the same command resumes");
  }
}

int DatasetCommand::make() {
  if (!status_.empty()) return status();
  if (!other_spec_.empty()) return difference();
  if (folder_.empty()) throw SceneError("--output: is required, accepted: a folder");
  if (!joined_.empty()) return join();
  const dataset::Spec spec =
      spec_file_.empty() ? dataset::readFolderSpec(folder_) : dataset::readSpec(spec_file_);
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
          "{} loops, {:.1f} MB; {} hearts were kept from earlier runs, {} failed, {} impossible "
          "draws\n",
          made.loops, static_cast<double>(made.bytes) * 1e-6, made.kept, made.failed,
          made.impossible);
    if (!task_.empty()) return 0;
  }
  // A run without --merge has just proven the bytes of what it kept.
  dataset::MergeOptions merging{.fast = fast_ || !merge_, .threads = threads_};
  for (const std::string& loop : real_) {
    const auto [file, mm_per_pixel] = parseRealLoop(loop);
    merging.real.push_back({file, mm_per_pixel});
  }
  const dataset::MakeSummary merged = dataset::mergeParts(
      spec, folder_, merging,
      {.keep_going = [] { return !stopWanted(); }, .warn = warningPrinter(quiet_)});
  if (merged.failed > 0)
    fmt::print(stderr, "{} of {} hearts failed: {}\n", merged.failed, spec.hearts,
               (folder_ / "failed.csv").string());
  if (!quiet_) printMade(merged.merged, merged.loops, folder_);
  return 0;
}

int DatasetCommand::status() const {
  const dataset::Status now = dataset::statusOf(status_);
  fmt::print("{}: {} of {} hearts finished, {} failed, {} missing{}; {}\n", now.name, now.finished,
             now.hearts, now.failed, now.hearts - now.finished - now.failed,
             now.damaged > 0 ? fmt::format(" ({} damaged)", now.damaged) : "",
             now.merged ? "merged" : "not merged");
  if (!now.first_failure.empty()) fmt::print("first failure: {}\n", now.first_failure);
  if (!now.running.empty()) fmt::print("running: {}\n", fmt::join(now.running, ", "));
  return 0;
}

int DatasetCommand::difference() const {
  const auto textOf = [](const std::filesystem::path& file) {
    std::error_code absent;
    return std::filesystem::is_directory(file, absent) ? dataset::readFolderSpec(file).text
                                                       : dataset::readSpec(file).text;
  };
  const auto& own = spec_file_.empty() ? folder_ : spec_file_;
  if (own.empty()) throw SceneError("--diff: needs a spec, or a folder in --output");
  for (const std::string& line : dataset::differencesOf(textOf(own), textOf(other_spec_)))
    fmt::print("{}\n", line);
  return 0;
}

int DatasetCommand::join() const {
  ProgressBar bar(quiet_);
  const dataset::JoinSummary made =
      dataset::joinDatasets(joined_, folder_, {join_name_}, countingHearts(bar, quiet_));
  bar.finish();
  if (!quiet_ && !made.left_out.empty())
    fmt::print("left out, because not all parts have them: {}\n", fmt::join(made.left_out, ", "));
  if (!quiet_) printMade(made.hearts, made.loops, folder_);
  return 0;
}

int DatasetCommand::preview(const dataset::Spec& spec) const {
  if (folder_.extension() != ".html")
    throw SceneError(fmt::format(
        "--output: \"{}\" is not a page, accepted with --preview: a name that ends in .html",
        folder_.string()));
  ProgressBar bar(quiet_);
  const dataset::PreviewSummary made =
      dataset::writePreview(spec, folder_, preview_, threads_, countingHearts(bar, quiet_));
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
  dataset::HeartCost cost;
  if (tasks_ == 0 || minutes_ == 0) {
    const dataset::WorkFolder refused_here(folder_, spec);  // not after a heart
    cost = dataset::costOfAHeart(spec, folder_, {.keep_going = [] { return !stopWanted(); }});
    const double heart_s = cost.seconds;
    if (tasks_ == 0) options.tasks = dataset::slurmTasks(spec.hearts, heart_s, cores_);
    if (minutes_ == 0)
      options.minutes = dataset::slurmMinutes(spec.hearts, heart_s, cores_, options.tasks);
  }
  options.tasks = std::min(options.tasks, spec.hearts);
  options.cores = dataset::slurmCores(spec.hearts, options.tasks, cores_);
  if (cost.memory_mb > 0)
    options.memory_mb = dataset::slurmMemory_mb(cost.memory_mb, options.cores);
  const std::filesystem::path submit = dataset::writeSlurmJobs(spec, options);
  if (!quiet_)
    fmt::print("{}: {} tasks of {} cores and at most {} minutes, then a merge\n",
               submit.parent_path().string(), options.tasks, options.cores, options.minutes);
  std::fflush(stdout);
  if (!no_submit_ && !runScript(submit))
    throw JobError(
        fmt::format("{}: sbatch failed; the jobs are written, run this script to submit them",
                    submit.string()));
  return 0;
}

}  // namespace echocine
