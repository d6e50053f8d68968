#pragma once
// echocine dataset: a spec in, a folder of many loops with ground truth out.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace echocine::dataset {
struct Spec;
}

namespace echocine {

class DatasetCommand {
 public:
  explicit DatasetCommand(CLI::App& app);
  int run();

 private:
  int make();
  int preview(const dataset::Spec& spec) const;
  int slurm(const dataset::Spec& spec) const;
  int status() const;
  int difference() const;
  int join() const;

  std::filesystem::path spec_file_, folder_, status_, other_spec_;
  std::vector<std::filesystem::path> joined_;
  std::vector<std::string> real_;
  std::optional<std::string> join_name_;
  std::string task_, sbatch_;
  int threads_ = 0, preview_ = 0;
  int tasks_ = 0, cores_ = 4, minutes_ = 0;  // of Slurm's jobs; 0: derived from the first heart
  bool merge_ = false, fast_ = false, slurm_ = false, no_submit_ = false, quiet_ = false;
};

}  // namespace echocine
