#pragma once
// Half-written files: each stands beside its target as TARGET.XXXXXXXX.part, a name of its own,
// until it is whole and renamed.

#include <filesystem>
#include <string>
#include <string_view>

namespace echocine {

// A new, empty part of `path`, open to read and write. Never an existing file and never through a
// link (O_EXCL), so writers of the same target do not share one. descriptor < 0, with errno, when
// it cannot be made.
struct PartFile {
  std::string name;
  int descriptor = -1;
};
PartFile makePart(const std::filesystem::path& path);

// "cine.avi" of "cine.avi.0a1b2c3d.part", and of "cine.avi.part" as versions before 0.2 wrote;
// empty for a name of another kind.
std::string_view targetOfPart(std::string_view file_name);

// Removes what killed runs left of this file. What cannot be removed stays.
void removePartsOf(const std::filesystem::path& path);

}  // namespace echocine
