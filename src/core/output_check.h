#pragma once
// Checks of a place for results, before the work that leads to them.

#include <filesystem>
#include <initializer_list>

namespace echocine {

// Throws JobError if no file can be written at the path: it is a folder, or its own folder does not
// exist or takes no files. Removes parts of runs that were killed there.
void checkOutputFile(const std::filesystem::path& file);

// The same for files in a folder that is made when they are written. A folder that does not exist
// is not made; then that in which it will stand is checked.
void checkOutputFolder(const std::filesystem::path& folder,
                       std::initializer_list<const char*> files);

}  // namespace echocine
