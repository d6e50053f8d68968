#include "dataset/status.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/file.h"
#include "dataset/folder_spec.h"
#include "dataset/record.h"
#include "dataset/work_folder.h"

namespace echocine::dataset {

namespace {

// A dataset that has grown keeps the tables of the earlier spec until it is merged again.
bool hasTablesOf(const Spec& spec, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "dataset.json";
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) return false;
  constexpr std::size_t kMostTableBytes = std::size_t{256} << 20;
  const auto json = nlohmann::json::parse(readTextFile(file, kMostTableBytes), nullptr, false);
  return json.is_object() && json.contains("spec_sha256") && json["spec_sha256"] == spec.digest;
}

}  // namespace

Status statusOf(const std::filesystem::path& folder) {
  std::error_code failed;
  if (isJoined(folder))
    throw SceneError(fmt::format("{}: holds joined datasets, accepted: the folder of one spec",
                                 folder.string()));
  if (!std::filesystem::exists(folder / "work/spec.json", failed) ||
      !std::filesystem::exists(folder / "spec.toml", failed))
    throw SceneError(fmt::format("{}: holds no dataset", folder.string()));
  const Spec spec = readFolderSpec(folder);
  const WorkFolder work(folder, spec);
  Status status;
  status.name = spec.name;
  status.hearts = spec.hearts;
  for (int heart = 0; heart < spec.hearts; ++heart) {
    const WorkFolder::Finished one = work.finished(heart, WorkFolder::Look::sizes);
    status.damaged += !one.flaw.empty();
    if (!one.record) continue;
    if (!isFailure(*one.record)) {
      ++status.finished;
      continue;
    }
    ++status.failed;
    if (status.first_failure.empty())
      status.first_failure = one.record->at("failed").get<std::string>();
  }
  status.merged = hasTablesOf(spec, folder);
  status.running = work.runningTasks();
  return status;
}

}  // namespace echocine::dataset
