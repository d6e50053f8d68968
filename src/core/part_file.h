#pragma once
// Temporary files: each has its own name TARGET.XXXXXXXX.part beside its target until it is
// complete and renamed.

#include <filesystem>
#include <string>
#include <string_view>

namespace echocine {

// A new, empty part of `path`, open for reading and writing. Never an existing file and never
// through a link (O_EXCL), so writers of one target do not share a part. It is locked while the
// descriptor is open. descriptor < 0, with errno, on failure.
struct PartFile {
  std::string name;
  int descriptor = -1;
};
PartFile makePart(const std::filesystem::path& path);

// "cine.avi" for "cine.avi.0a1b2c3d.part", and for "cine.avi.part" of versions before 0.2; empty
// for any other name.
std::string_view targetOfPart(std::string_view file_name);

// Removes parts of this file left by killed runs. Parts that a writer holds open stay, and files
// that cannot be removed.
void removePartsOf(const std::filesystem::path& path);

}  // namespace echocine
