#include "dataset/work_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/file_lock.h"
#include "dataset/folder_spec.h"
#include "dataset/growth.h"
#include "dataset/record.h"
#include "dataset/record_check.h"

namespace echocine::dataset {

namespace {

constexpr std::size_t kMostRecordBytes = std::size_t{64} << 20;

// Nothing where there is no such file, or something else than a file.
std::optional<std::string> readText(const std::filesystem::path& file) {
  if (!isOrdinaryFile(file)) return std::nullopt;
  try {
    return readTextFile(file, kMostRecordBytes);
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

void writeText(const std::filesystem::path& file, const std::string& text) {
  makeFolder(file.parent_path());
  writeFileWhole(file, std::as_bytes(std::span(text)));
}

bool isEmptyFolder(const std::filesystem::path& folder) {
  std::error_code failed;
  return !std::filesystem::exists(folder, failed) ||
         (std::filesystem::is_directory(folder, failed) &&
          std::filesystem::directory_iterator(folder, failed) ==
              std::filesystem::directory_iterator());
}

std::string markText(const Spec& spec) {
  return Json{{"digest", spec.heart_digest}}.dump() + "\n";
}

[[noreturn]] void failOfOtherSpec(const std::filesystem::path& folder, const std::string& fault) {
  throw SceneError(fmt::format(
      "{}: holds the dataset of another spec or program version{}: choose another folder",
      folder.string(), fault.empty() ? "" : fmt::format(" ({})", fault)));
}

// The spec of the folder's copy; none if it is missing or damaged.
std::optional<Spec> specOfFolder(const std::filesystem::path& folder, const Spec& like) {
  const std::optional<std::string> text = readText(folder / "spec.toml");
  if (!text) return std::nullopt;
  try {
    return parseSpec(*text, like.file);  // scenes are relative to it
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

// Why a file is not as its record has it; empty where it is.
std::string flawOfFile(const std::filesystem::path& folder, const std::string& name,
                       const Json& noted, WorkFolder::Look look) {
  if (!linkBelow(folder, name).empty()) return "is reached through a link";
  const std::filesystem::path file = folder / name;
  if (!isOrdinaryFile(file)) return "is missing or not a regular file";
  std::error_code failed;
  if (std::filesystem::file_size(file, failed) != noted["bytes"].get<std::uint64_t>() || failed)
    return "has another size than recorded";
  if (look == WorkFolder::Look::sizes) return {};
  const std::optional<FileMark> mark = markOf(file);
  return mark && mark->digest == noted["digest"].get<std::string>() ? "" : "was modified";
}

}  // namespace

WorkFolder::WorkFolder(std::filesystem::path folder, const Spec& spec)
    : folder_(std::move(folder)), spec_(spec) {
  const std::filesystem::path work = folder_ / "work", mark = work / "spec.json";
  std::error_code failed;
  if (std::filesystem::is_symlink(work, failed))
    throw SceneError(fmt::format("{}: is a link: choose a new or empty folder", work.string()));
  if (isJoined(folder_))
    throw SceneError(
        fmt::format("{}: holds joined datasets: choose another folder", folder_.string()));
  if (const std::optional<std::string> earlier = readText(mark)) {
    const bool same = *earlier == markText(spec);
    const std::optional<Spec> before = same && readText(folder_ / "spec.toml") == spec.text
                                           ? std::nullopt
                                           : specOfFolder(folder_, spec);
    const std::string fault = before ? growthFault(*before, spec) : "";
    const bool damaged = before && markText(*before) != *earlier;
    if (!same || (!fault.empty() && !damaged)) failOfOtherSpec(folder_, fault);
    keepFolderSpec(folder_, spec);
    return;
  }
  // A run that was killed at once leaves an empty work folder.
  if (!isEmptyFolder(folder_) && !std::filesystem::exists(work, failed))
    throw SceneError(
        fmt::format("{}: holds unrelated files: choose a new or empty folder", folder_.string()));
  makeFolder(work);
  // If tasks begin together, one of them writes the mark; the others find their own spec in it.
  const std::string own = markText(spec);
  if (!writeFileOnce(mark, std::as_bytes(std::span(own))) && readText(mark) != own)
    failOfOtherSpec(folder_, "");
  // A run that was killed after its mark has no copy of the spec, and a disk may damage one.
  keepFolderSpec(folder_, spec);
}

// A thousand to a folder: file systems are slow with more.
std::filesystem::path recordFile(const std::filesystem::path& folder, int heart) {
  const int number = heart + 1;
  return folder / "work" / fmt::format("{:04}", number / 1000) / fmt::format("{:07}.json", number);
}

bool isJoined(const std::filesystem::path& folder) {
  std::error_code failed;
  return std::filesystem::exists(folder / kJoinedMark, failed);
}

void WorkFolder::finish(int heart, Json record,
                        const std::map<std::string, FileMark>& files) const {
  record["files"] = marksJson(files);
  writeText(recordFile(folder_, heart), sealedText(record));
}

WorkFolder::Finished WorkFolder::finished(int heart, Look look) const {
  const std::filesystem::path file = recordFile(folder_, heart);
  std::error_code failed;
  if (std::filesystem::symlink_status(file, failed).type() == std::filesystem::file_type::not_found)
    return {};
  const std::string name = std::filesystem::relative(file, folder_).string();
  const std::optional<std::string> text = readText(file);
  if (!text) return {std::nullopt, name + ": cannot be read, or is not a regular file"};
  CheckedRecord checked = checkRecord(*text, spec_, heart);
  if (checked.outgrown) return {};
  if (!checked.flaw.empty()) return {std::nullopt, name + ": " + checked.flaw};
  if (isFailure(checked.record)) return {std::move(checked.record), ""};
  for (const auto& [noted_name, noted] : checked.record["files"].items())
    if (const std::string flaw = flawOfFile(folder_, noted_name, noted, look); !flaw.empty())
      return {std::nullopt, noted_name + ": " + flaw};
  return {std::move(checked.record), ""};
}

void WorkFolder::removeParts() const {
  std::vector<std::filesystem::path> parts;
  std::error_code failed;
  for (std::filesystem::recursive_directory_iterator it(folder_, failed), end; it != end;
       it.increment(failed))
    if (!targetOfPart(it->path().filename().string()).empty() && isOrdinaryFile(it->path()))
      parts.push_back(it->path());
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "work", failed)) {
    if (!entry.path().filename().string().starts_with("task_")) continue;
    if (isFileLocked(entry.path() / kLockName)) return;
    parts.push_back(entry.path() / kLockName);  // of a killed task, if any
  }
  for (const std::filesystem::path& part : parts) std::filesystem::remove(part, failed);
}

std::vector<std::string> WorkFolder::runningTasks() const {
  std::vector<std::string> running;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "work", failed)) {
    std::string name = entry.path().filename().string();
    if (name.starts_with("task_") && isFileLocked(entry.path() / kLockName))
      running.push_back(std::move(name));
  }
  std::sort(running.begin(), running.end());
  return running;
}

}  // namespace echocine::dataset
