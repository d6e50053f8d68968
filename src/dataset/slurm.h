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
  std::string more;               // options of sbatch for every job, such as "--partition=cpu"
};

// Number of tasks of about half an hour each on `cores` cores, from the seconds of one heart (our
// choice: short for a scheduler, long compared with its overhead). At most the number of hearts,
// and at most 1,000, the limit of Slurm's default MaxArraySize, 1,001.
int slurmTasks(int hearts, double heart_s, int cores);

// Three times the expected duration of a task by `heart_s`, at least a quarter of an hour; our
// choice.
int slurmMinutes(int hearts, double heart_s, int cores, int tasks);

// Writes array.sh, merge.sh and submit.sh into `folder`/slurm, in a readable form, and returns
// submit.sh. A killed or requeued task resumes where it stopped. Throws SceneError if the folder
// belongs to another spec, JobError if files cannot be written.
std::filesystem::path writeSlurmJobs(const Spec& spec, const SlurmOptions& options);

}  // namespace echocine::dataset
