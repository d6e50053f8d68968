#pragma once
// The state of a dataset in its folder, without a change of it.

#include <filesystem>
#include <string>
#include <vector>

namespace echocine::dataset {

struct Status {
  std::string name;
  int hearts = 0;                    // of the spec
  int finished = 0, failed = 0;      // by their records; files are compared by size
  int damaged = 0;                   // records or files that are not as they were written
  bool merged = false;               // the tables are those of the spec
  std::vector<std::string> running;  // tasks that hold their lock, such as "task_3_of_8"
  std::string first_failure;
};

// Throws SceneError if the folder holds no dataset.
Status statusOf(const std::filesystem::path& folder);

}  // namespace echocine::dataset
