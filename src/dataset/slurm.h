#pragma once
// A dataset as Slurm jobs: an array whose tasks render the parts, followed by a job that merges.

#include <filesystem>
#include <string>

#include "dataset/spec.h"

namespace echocine::dataset {

struct SlurmOptions {
  std::filesystem::path program;  // echocine, as seen by the nodes
  std::filesystem::path folder;   // of the dataset, visible to all nodes
  int tasks = 1;                  // of the array
  int cores = 4;                  // of a task
  int minutes = 60;               // time limit of a task
  int memory_mb = 0;              // of a task, 2^20 bytes; 0: the cluster's default
  std::string more;               // options of sbatch for every job, such as "--partition=cpu"
};

// Number of tasks of about half an hour each on `cores` cores, from the seconds of one heart (our
// choice: short for a scheduler, long compared with its overhead). At most the number of hearts,
// and at most 1,000, the limit of Slurm's default MaxArraySize, 1,001.
int slurmTasks(int hearts, double heart_s, int cores);

// Three times the expected duration of a task by `heart_s`, at least a quarter of an hour; our
// choice.
int slurmMinutes(int hearts, double heart_s, int cores, int tasks);

// Cores that a task of `tasks` can use: a heart runs on one.
int slurmCores(int hearts, int tasks, int cores);

// One and a half times what `cores` hearts need at once, by the memory of a process with one, plus
// 256 MB for the page cache; our choice. Never less than for two.
int slurmMemory_mb(double heart_mb, int cores);

// Writes array.sh, merge.sh and submit.sh into `folder`/slurm, in a readable form, and returns
// submit.sh. A killed or requeued task resumes where it stopped;
// a minute before its time limit it requeues itself, at most 20 times (our choice). The jobs read
// the spec in the folder. Throws SceneError if the folder
// belongs to another spec, JobError if files cannot be written.
std::filesystem::path writeSlurmJobs(const Spec& spec, const SlurmOptions& options);

}  // namespace echocine::dataset
