#include "dataset/slurm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/error.h"
#include "core/file.h"
#include "dataset/work_folder.h"

namespace echocine::dataset {

namespace {

constexpr double kTask_s = 1800;
constexpr int kMostTasks = 1000, kLeastMinutes = 15;

// As a word of a shell, whatever is in it.
std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

// A valid name of a job: letters, digits, "-" and "_".
std::string jobName(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  return name;
}

std::string command(const SlurmOptions& options) {
  return fmt::format("{} dataset -o {} --quiet", quoted(options.program.string()),
                     quoted(std::filesystem::absolute(options.folder).string()));
}

// sbatch replaces %A, %a, ... in the names of logs, whatever folder they are in.
std::string logName(const SlurmOptions& options, const char* name) {
  std::string folder;
  for (const char c : std::filesystem::absolute(options.folder / "slurm").string())
    folder += c == '%' ? std::string("%%") : std::string(1, c);
  return quoted(folder + "/" + name);
}

std::string memoryLine(const SlurmOptions& options) {
  return options.memory_mb > 0 ? fmt::format("#SBATCH --mem={}M\n", options.memory_mb) : "";
}

std::string arrayText(const Spec& spec, const SlurmOptions& options) {
  return fmt::format(
      R"(#!/bin/sh
# A part of the dataset: as many as the array has tasks. Finished hearts are kept, so a task that is
# killed, requeued or submitted again goes on.
#SBATCH --job-name={}
#SBATCH --array=1-{}
#SBATCH --cpus-per-task={}
#SBATCH --time={}
{}#SBATCH --requeue
#SBATCH --signal=B:USR1@60
#SBATCH --open-mode=append
# Close to the time limit: stop, keep finished hearts and queue again.
stop() {{
  [ -z "$made" ] || kill -TERM "$made" 2>/dev/null
  wait
}}
again() {{
  stop
  [ "${{SLURM_RESTART_COUNT:-0}}" -lt 20 ] || exit 1
  scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID" || exit 1
  sleep 300  # until Slurm ends this run: its own end would count as that of the queued one
  exit 1
}}
made=
trap again USR1
trap 'stop; exit 1' TERM
{} --threads "${{SLURM_CPUS_PER_TASK:-0}}" --task "$SLURM_ARRAY_TASK_ID/{}" &
made=$!
wait "$made"
)",
      jobName(spec.name), options.tasks, options.cores, options.minutes, memoryLine(options),
      command(options), options.tasks);
}

std::string mergeText(const Spec& spec, const SlurmOptions& options) {
  return fmt::format(
      R"(#!/bin/sh
# Proves that every heart is there and writes the tables.
#SBATCH --job-name={}_merge
#SBATCH --cpus-per-task=1
#SBATCH --time={}
#SBATCH --requeue
#SBATCH --open-mode=append
exec {} --merge
)",
      jobName(spec.name), std::max(options.minutes, kLeastMinutes), command(options));
}

std::string submitText(const SlurmOptions& options) {
  const std::string more = options.more.empty() ? "" : options.more + " ";
  return fmt::format(
      R"(#!/bin/sh
# Submits the array, and the merge for when all its tasks have ended: it says which hearts are missing, if any.
set -e
cd {}
array=$(sbatch --parsable --output={} {}array.sh)
array=${{array%%;*}}
printf 'array %s, ' "$array"
merge=$(sbatch --parsable --output={} {}--dependency="afterany:$array" merge.sh) || {{
  scancel "$array"
  echo "canceled: its merge was refused"
  exit 1
}}
echo "merge ${{merge%%;*}}"
)",
      quoted(std::filesystem::absolute(options.folder / "slurm").string()),
      logName(options, "array_%A_%a.log"), more, logName(options, "merge_%j.log"), more);
}

}  // namespace

int slurmTasks(int hearts, double heart_s, int cores) {
  const double tasks = std::ceil(hearts * heart_s / cores / kTask_s);
  return static_cast<int>(
      std::clamp(tasks, 1.0, static_cast<double>(std::min(hearts, kMostTasks))));
}

int slurmMinutes(int hearts, double heart_s, int cores, int tasks) {
  const int each = (hearts + tasks - 1) / tasks;
  const double rounds = std::ceil(static_cast<double>(each) / cores);
  return std::max(kLeastMinutes, static_cast<int>(std::ceil(3 * rounds * heart_s / 60)));
}

int slurmCores(int hearts, int tasks, int cores) {
  return std::clamp((hearts + tasks - 1) / tasks, 1, cores);
}

int slurmMemory_mb(double heart_mb, int cores) {
  return static_cast<int>(std::ceil(1.5 * heart_mb * std::max(2, cores))) + 256;
}

std::filesystem::path writeSlurmJobs(const Spec& spec, const SlurmOptions& options) {
  const WorkFolder work(options.folder, spec);
  const std::filesystem::path folder = options.folder / "slurm";
  makeFolder(folder);
  const auto write = [&](const char* name, const std::string& text) {
    writeFileWhole(folder / name, std::as_bytes(std::span(text)));
  };
  write("array.sh", arrayText(spec, options));
  write("merge.sh", mergeText(spec, options));
  write("submit.sh", submitText(options));
  return folder / "submit.sh";
}

}  // namespace echocine::dataset
