#include "dataset/work_folder.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file.h"
#include "dataset/record.h"

namespace echocine::dataset {

namespace {

constexpr std::size_t kMostRecordBytes = std::size_t{64} << 20;

// Nothing where there is no such file or no JSON in it: then it was never finished.
std::optional<Json> readJson(const std::filesystem::path& file) {
  std::error_code absent;
  if (!std::filesystem::exists(file, absent)) return std::nullopt;
  try {
    return Json::parse(readTextFile(file, kMostRecordBytes));
  } catch (const std::exception&) {
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

bool isAsNoted(const std::filesystem::path& file, const Json& noted, WorkFolder::Look look) {
  std::error_code failed;
  if (std::filesystem::file_size(file, failed) != noted["bytes"].get<std::uint64_t>() || failed)
    return false;
  if (look == WorkFolder::Look::sizes) return true;
  const std::optional<FileMark> mark = markOf(file);
  return mark && mark->digest == noted["digest"].get<std::string>();
}

}  // namespace

WorkFolder::WorkFolder(std::filesystem::path folder, const Spec& spec)
    : folder_(std::move(folder)), digest_(spec.digest) {
  const std::filesystem::path mark = folder_ / "work" / "spec.json";
  if (const std::optional<Json> earlier = readJson(mark)) {
    if (earlier->value("digest", std::string()) == digest_) return;
    throw SceneError(fmt::format(
        "{}: holds the dataset of another spec or program version: choose another folder",
        folder_.string()));
  }
  // A run that was killed at once leaves an empty work folder.
  if (!isEmptyFolder(folder_) && !std::filesystem::exists(folder_ / "work"))
    throw SceneError(fmt::format("{}: holds files of something else: choose a new or empty folder",
                                 folder_.string()));
  writeText(mark, Json{{"digest", digest_}, {"name", spec.name}}.dump() + "\n");
  writeText(folder_ / "spec.toml", spec.text);
}

// A thousand to a folder: file systems are slow with more.
std::filesystem::path WorkFolder::recordFile(int heart) const {
  const int number = heart + 1;
  return folder_ / "work" / fmt::format("{:04}", number / 1000) / fmt::format("{:07}.json", number);
}

void WorkFolder::finish(int heart, Json record,
                        const std::map<std::string, FileMark>& files) const {
  record["files"] = Json::object();
  for (const auto& [name, mark] : files)
    record["files"][name] = {{"bytes", mark.bytes}, {"digest", mark.digest}};
  writeText(recordFile(heart), record.dump() + "\n");
}

std::optional<Json> WorkFolder::finished(int heart, Look look) const {
  std::optional<Json> record = readJson(recordFile(heart));
  try {
    if (!record || record->at("spec") != digest_) return std::nullopt;
    if (isFailure(*record)) return record;
    for (const auto& [name, noted] : record->at("files").items())
      if (!isAsNoted(folder_ / name, noted, look)) return std::nullopt;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  return record;
}

}  // namespace echocine::dataset
