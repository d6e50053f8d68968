#include "core/output_check.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "core/part_file.h"

namespace echocine {

namespace fs = std::filesystem;

void checkOutputFile(const fs::path& file) {
  std::error_code absent;
  if (fs::is_directory(file, absent))
    throw JobError(fmt::format("{}: is a folder, a file is needed there", file.string()));
  removePartsOf(file);
  if (!fs::exists(file, absent) || isOrdinaryFile(file))  // nothing is tried at pipes and devices
    const WholeFile trial(file);                          // removed, because it is not finished
}

void checkOutputFolder(const fs::path& folder, std::initializer_list<const char*> files) {
  std::error_code absent;
  fs::path there = fs::absolute(folder);
  while (!fs::exists(there, absent) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, absent))
    throw JobError(fmt::format("{}: is a file, a folder is needed", there.string()));
  if (fs::is_directory(folder, absent)) {
    for (const char* name : files) checkOutputFile(folder / name);
  } else if (::access(there.c_str(), W_OK | X_OK) != 0) {
    throw JobError(fmt::format("{}: cannot be created: {}", folder.string(), std::strerror(errno)));
  }
}

}  // namespace echocine
