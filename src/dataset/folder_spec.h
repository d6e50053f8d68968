#pragma once
// The spec of a dataset's folder: its text in spec.toml, and in work/source.json the file that it
// was read from, on which the default name and relative scenes depend.

#include <filesystem>

#include "dataset/spec.h"

namespace echocine::dataset {

// The spec of an earlier run in the folder. Throws SceneError if the folder has none, or if its
// scenes are no longer at their places.
Spec readFolderSpec(const std::filesystem::path& folder);

// Writes both files where they differ. The source is a file name; with scenes, an absolute path.
// Throws JobError.
void keepFolderSpec(const std::filesystem::path& folder, const Spec& spec);

}  // namespace echocine::dataset
