#pragma once
// The folder of a run: made, found writable, and rid of what earlier runs left.

#include <filesystem>

#include "core/folder_lock.h"
#include "scene/scene.h"

namespace echocine {

class OutputFolder {
 public:
  // Makes `folder` and, as far as the settings ask for them, its intensity/ and png/, and keeps
  // other runs out of it. Removes an earlier manifest.json and its report at once: a folder without
  // them is an unfinished run. Throws JobError when the path is a file, nothing can be written
  // there, another run is at work there, or a folder stands in the place of a file.
  OutputFolder(std::filesystem::path folder, const OutputSettings& settings, bool resume);

  // Deletes leftovers of earlier runs. On resuming: frames past the loop's end and half-written
  // files; pictures too where no EXR proves whose they are. Otherwise every frame and the cine too,
  // for a run that ends early must not leave a mix of two. Files with names of other kinds are
  // never touched. Throws JobError.
  void removeStale(int frame_count) const;

  // Throws JobError when the folder was removed or replaced since.
  void checkStillThere() const { lock_.checkStillThere(); }

  std::filesystem::path intensity() const { return folder_ / "intensity"; }
  std::filesystem::path png() const { return folder_ / "png"; }
  std::filesystem::path truth() const { return folder_ / "truth"; }
  std::filesystem::path cine() const { return folder_ / "cine.avi"; }
  std::filesystem::path report() const { return folder_ / "report.html"; }
  std::filesystem::path manifest() const { return folder_ / "manifest.json"; }

 private:
  void removeTruth(int first) const;
  std::filesystem::path folder_;
  FolderLock lock_;
  bool resume_, exr_;
};

}  // namespace echocine
