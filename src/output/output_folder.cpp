#include "output/output_folder.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/file.h"

namespace echocine {
namespace {

namespace fs = std::filesystem;

// The folder and those above it, as a user who names a new path means it.
fs::path madeFolder(const fs::path& folder) {
  std::error_code failed;
  if (fs::exists(folder, failed) && !fs::is_directory(folder, failed))
    throw JobError(fmt::format("{}: is a file, a folder is needed", folder.string()));
  fs::create_directories(folder, failed);
  if (failed)
    throw JobError(
        fmt::format("{}: the folder cannot be created: {}", folder.string(), failed.message()));
  return folder;
}

// Found out now, not when hours later the file is to take its place.
void refuseFolderAt(const fs::path& file) {
  std::error_code absent;
  if (fs::is_directory(file, absent))
    throw JobError(fmt::format("{}: is a folder, a file is needed there", file.string()));
}

// A file that is not there is removed already.
void removeFile(const fs::path& path) {
  std::error_code failed;
  fs::remove(path, failed);
  if (failed)
    throw JobError(fmt::format("{}: cannot be removed: {}", path.string(), failed.message()));
}

// Permissions are not sufficient (full disks, read-only mounts, a superuser), so a file is written.
void tryWriting(const fs::path& folder) {
  const fs::path name = folder / "write_test";
  removePartsOf(name);  // of a run that was killed here
  WholeFile trial(name);
  trial.write(std::as_bytes(std::span(std::string_view("echocine"))));
}

// The number in "frame_0012.exr" for "frame_" and ".exr"; nothing for any other name.
std::optional<int> frameNumber(std::string_view name, const NumberedNames& names) {
  const std::string whole(name);
  const auto [stem, ending] = names;
  if (!name.starts_with(stem) || !name.ends_with(ending)) return std::nullopt;
  if (name.size() <= stem.size() + ending.size()) return std::nullopt;
  name.remove_prefix(stem.size());
  name.remove_suffix(ending.size());
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || end != name.data() + name.size() || number < 0) return std::nullopt;
  // Only names that a run writes: "frame_12.exr" is somebody's own.
  if (fmt::format("{}{:04}{}", stem, number, ending) != whole) return std::nullopt;
  return number;
}

}  // namespace

// Listed first and removed then: what a directory iterator sees while files vanish is not defined.
void removeNumbered(const fs::path& folder, const NumberedNames& names, int first) {
  std::vector<fs::path> stale;
  std::error_code absent;
  for (fs::directory_iterator it(folder, absent), end; it != end; it.increment(absent)) {
    const std::string name = it->path().filename().string();
    const std::optional<int> number = frameNumber(name, names);
    if ((number && *number >= first) || frameNumber(targetOfPart(name), names))
      stale.push_back(it->path());
  }
  for (const fs::path& path : stale) removeFile(path);
}

OutputFolder::OutputFolder(fs::path folder, const OutputSettings& settings, bool resume)
    : folder_(madeFolder(folder)), lock_(folder_), resume_(resume), exr_(settings.exr) {
  if (settings.cine) refuseFolderAt(cine());
  if (settings.dicom) refuseFolderAt(dicom());
  if (settings.volumes) refuseFolderAt(volumes());
  refuseFolderAt(manifest());
  tryWriting(folder_);
  // Only folders that this run fills: others may be links to places that take no files.
  for (const auto& [wanted, subfolder] :
       {std::pair(settings.exr, intensity()), {settings.png, png()}}) {
    if (!wanted) continue;
    madeFolder(subfolder);
    tryWriting(subfolder);
  }
  removeFile(manifest());
  removeFile(report());
  removePartsOf(report());
}

// Files of the whole loop are made anew by every run that wants them.
void OutputFolder::removeTruth(int first) const {
  std::error_code failed;
  if (!fs::is_directory(truth(), failed)) return;
  removeNumbered(truth(), {"labels_", ".png"}, first);
  removeNumbered(truth(), {"contours_", ".json"}, first);
  for (const char* name : {"labels.json", "tracks.npz", "function.json"}) {
    removeFile(truth() / name);
    removePartsOf(truth() / name);
  }
  fs::remove(truth(), failed);  // only an empty one goes
}

// Pictures without an EXR beside them bear no scene's name, so on resuming they are not trusted.
void OutputFolder::removeStale(int frame_count) const {
  const int first = resume_ ? frame_count : 0;
  removeNumbered(intensity(), {"frame_", ".exr"}, first);
  removeNumbered(png(), {"frame_", ".png"}, exr_ ? first : 0);
  removeTruth(exr_ ? first : 0);
  for (const fs::path& loop : {cine(), dicom()}) {
    if (!resume_) removeFile(loop);
    removePartsOf(loop);
  }
  removeFile(volumes());
  removePartsOf(volumes());
  removePartsOf(manifest());
}

}  // namespace echocine
