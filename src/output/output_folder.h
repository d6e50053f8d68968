#pragma once
// The folder of a run: created, checked for writing, cleaned of earlier runs.

#include <filesystem>
#include <string_view>

#include "core/folder_lock.h"
#include "scene/scene.h"

namespace echocine {

// Names of numbered files: stem, four digits or more, ending.
struct NumberedNames {
  std::string_view stem, ending;
};

// Deletes the files that are numbered `first` or higher, and half-written ones of any number. Files
// of other names stay. Throws JobError.
void removeNumbered(const std::filesystem::path& folder, const NumberedNames& names, int first);

class OutputFolder {
 public:
  // Creates `folder` and, as the settings require, its intensity/ and png/, and locks out other
  // runs. Removes an earlier manifest.json and its report at once: a folder without them is an
  // unfinished run. Throws JobError if the path is a file, it is not writable, another run uses it,
  // or a folder is in the place of a file.
  OutputFolder(std::filesystem::path folder, const OutputSettings& settings, bool resume);

  // Deletes files of earlier runs. When resuming: frames beyond the loop's end and temporary files;
  // also pictures, if no EXR proves their origin. Otherwise every frame and the cine, because an
  // interrupted run must not leave a mixture. Files of other names are never touched. Throws
  // JobError.
  void removeStale(int frame_count) const;

  // Throws JobError if the folder has been removed or replaced.
  void checkStillThere() const { lock_.checkStillThere(); }

  std::filesystem::path intensity() const { return folder_ / "intensity"; }
  std::filesystem::path png() const { return folder_ / "png"; }
  std::filesystem::path truth() const { return folder_ / "truth"; }
  std::filesystem::path cine() const { return folder_ / "cine.avi"; }
  std::filesystem::path dicom() const { return folder_ / "cine.dcm"; }
  std::filesystem::path volumes() const { return folder_ / "volumes.csv"; }
  std::filesystem::path report() const { return folder_ / "report.html"; }
  std::filesystem::path manifest() const { return folder_ / "manifest.json"; }

 private:
  void removeTruth(int first) const;
  std::filesystem::path folder_;
  FolderLock lock_;
  bool resume_, exr_;
};

}  // namespace echocine
