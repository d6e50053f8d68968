#include "fit/results_folder.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/file.h"

namespace echocine::fit {

ResultsFolder::ResultsFolder(std::filesystem::path folder, std::initializer_list<const char*> last)
    : folder_(std::move(folder)) {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error || !std::filesystem::is_directory(folder_, error))
    throw JobError(fmt::format("{}: the folder cannot be created: {}", folder_.string(),
                               error ? error.message() : "a file has this name"));
  for (const char* name : last) {
    std::filesystem::remove(folder_ / name, error);
    removePartsOf(folder_ / name);  // of a run that was killed here
  }
}

void ResultsFolder::write(const char* name, const std::string& content) const {
  writeFileWhole(folder_ / name, std::as_bytes(std::span(content)));
}

}  // namespace echocine::fit
