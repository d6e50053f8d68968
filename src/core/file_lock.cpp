#include "core/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/error.h"
#include "core/file.h"

namespace echocine {

namespace {

// A link could lead the lock out of the folder.
int openedForWriting(const std::filesystem::path& file, int more) {
  constexpr int kMode = 0644;
  return ::open(file.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | more, kMode);
}

bool isHeldByOther(int descriptor) {
  return ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace

FileLock::FileLock(std::filesystem::path file) : file_(std::move(file)), descriptor_(-1) {
  makeFolder(file_.parent_path());
  do {  // again if another run removed the file between opening and locking
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = openedForWriting(file_, O_CREAT);
    if (descriptor_ < 0)
      throw JobError(fmt::format("{}: cannot be opened: {}", file_.string(), std::strerror(errno)));
    if (!isHeldByOther(descriptor_)) continue;
    ::close(descriptor_);
    throw JobError(
        fmt::format("{}: another run is writing there: wait for its end or choose another folder",
                    file_.parent_path().string()));
  } while (!isStillThere());
}

FileLock::~FileLock() {
  if (isStillThere()) ::unlink(file_.c_str());  // still locked, so it is this run's
  ::close(descriptor_);
}

bool FileLock::isStillThere() const {
  struct stat held {
  }, there{};
  return ::fstat(descriptor_, &held) == 0 && ::stat(file_.c_str(), &there) == 0 &&
         held.st_dev == there.st_dev && held.st_ino == there.st_ino;
}

void FileLock::checkStillThere() const {
  if (isStillThere()) return;
  throw JobError(fmt::format("{}: was removed or replaced while the run wrote there",
                             file_.parent_path().string()));
}

bool isFileLocked(const std::filesystem::path& file) {
  const int descriptor = openedForWriting(file, 0);
  if (descriptor < 0) return false;
  const bool locked = isHeldByOther(descriptor);
  ::close(descriptor);
  return locked;
}

}  // namespace echocine
