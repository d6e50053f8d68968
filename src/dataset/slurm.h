#pragma once
// A dataset as jobs of Slurm: an array whose tasks make the parts, and a job behind it that merges.

#include <filesystem>
#include <string>

#include "dataset/spec.h"

namespace echocine::dataset {

struct SlurmOptions {
  std::filesystem::path program;  // echocine, as the nodes see it
  std::filesystem::path folder;   // of the dataset, which all nodes see
  int tasks = 1;                  // of the array
  int cores = 4;                  // of a task
  int minutes = 60;               // a task's limit
  std::string more;  // options that sbatch is given for every job, such as "--partition=cpu"
};

// Hearts that a task makes in about half an hour (our choice: short enough for a scheduler's gaps,
// long against its overhead) on `cores` cores, from the seconds of one; no more tasks than hearts,
// nor than 1,000: arrays of Slurm's default MaxArraySize, 1,001, end there.
int slurmTasks(int hearts, double heart_s, int cores);

// Three times what a task takes by `heart_s`, and a quarter of an hour at least, our choice.
int slurmMinutes(int hearts, double heart_s, int cores, int tasks);

// Writes array.sh, merge.sh and submit.sh into `folder`/slurm, plain to read and to edit, and
// returns submit.sh. A task that is killed or requeued goes on where it stopped. Throws SceneError
// where the folder is another spec's, JobError where files cannot be written.
std::filesystem::path writeSlurmJobs(const Spec& spec, const SlurmOptions& options);

}  // namespace echocine::dataset
