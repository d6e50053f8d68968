#include "core/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"

namespace echocine {

FolderLock::FolderLock(std::filesystem::path folder)
    : folder_(std::move(folder)),
      descriptor_(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0)
    throw JobError(fmt::format("{}: cannot be opened: {}", folder_.string(), std::strerror(errno)));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw JobError(
      fmt::format("{}: another run is writing there: wait for its end or choose another folder",
                  folder_.string()));
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
}

void FolderLock::checkStillThere() const {
  struct stat held {
  }, there{};
  if (::fstat(descriptor_, &held) == 0 && ::stat(folder_.c_str(), &there) == 0 &&
      held.st_dev == there.st_dev && held.st_ino == there.st_ino)
    return;
  throw JobError(
      fmt::format("{}: was removed or replaced while the run wrote there", folder_.string()));
}

}  // namespace echocine
