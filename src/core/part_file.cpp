#include "core/part_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <vector>

#include "core/file_lock.h"
#include "core/file_target.h"
#include "core/hash_random.h"

namespace echocine {

namespace {

constexpr std::string_view kPart = ".part";
constexpr std::size_t kDigits = 8;

// A name, not a number of the simulation: it only has to differ between writers.
std::uint32_t differing() {
  static std::atomic<std::uint64_t> count{0};
  const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
  return static_cast<std::uint32_t>(hashOf(
      hashOf(static_cast<std::uint64_t>(::getpid()), static_cast<std::uint64_t>(now)), ++count));
}

bool areHexDigits(std::string_view text) {
  return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

PartFile makePart(const std::filesystem::path& path) {
  constexpr int kAttempts = 100;
  PartFile part;
  for (int i = 0; i < kAttempts; ++i) {
    part.name = fmt::format("{}.{:08x}.part", path.string(), differing());
    part.descriptor =
        ::open(part.name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (part.descriptor >= 0 || errno != EEXIST) break;
  }
  // A file system without locks leaves it unlocked.
  if (part.descriptor >= 0) ::flock(part.descriptor, LOCK_EX | LOCK_NB);
  return part;
}

std::string_view targetOfPart(std::string_view name) {
  if (!name.ends_with(kPart)) return {};
  name.remove_suffix(kPart.size());
  const std::size_t dot = name.rfind('.');
  if (dot != std::string_view::npos && name.size() - dot - 1 == kDigits &&
      areHexDigits(name.substr(dot + 1)))
    name = name.substr(0, dot);
  return name;
}

// Listed first and removed then: what a directory iterator sees while files vanish is not defined.
void removePartsOf(const std::filesystem::path& path) {
  const std::filesystem::path folder = folderOf(path);
  const std::string target = path.filename().string();
  std::vector<std::filesystem::path> parts;
  std::error_code failed;
  for (std::filesystem::directory_iterator it(folder, failed), end; it != end; it.increment(failed))
    if (targetOfPart(it->path().filename().string()) == target) parts.push_back(it->path());
  for (const std::filesystem::path& part : parts)
    if (!isFileLocked(part)) std::filesystem::remove(part, failed);
}

}  // namespace echocine
