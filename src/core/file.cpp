#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <utility>

#include "core/error.h"

namespace echocine {

std::string readTextFile(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed))
    throw SceneError(fmt::format("{}: is a folder, a file is needed", path.string()));
  // A pipe that nobody fills would have us wait for ever.
  if (std::filesystem::exists(path, failed) && !std::filesystem::is_regular_file(path, failed))
    throw SceneError(fmt::format("{}: is no ordinary file, such as is needed", path.string()));
  std::ifstream file(path, std::ios::binary);
  if (!file && errno == ENOMEM) throw std::bad_alloc();
  if (!file)
    throw SceneError(fmt::format("{}: cannot be opened: {}", path.string(), std::strerror(errno)));
  std::string text;
  std::string block(1 << 16, '\0');
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block, 0, static_cast<std::size_t>(file.gcount()));
    if (text.size() > max_bytes)
      throw SceneError(
          fmt::format("{}: larger than the {} bytes accepted", path.string(), max_bytes));
  }
  if (file.bad()) throw SceneError(fmt::format("{}: reading failed", path.string()));
  return text;
}

namespace {

bool writeAll(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

void makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw JobError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
}

bool syncFile(int descriptor) {
  int failed = 0;
  do failed = ::fsync(descriptor);
  while (failed != 0 && errno == EINTR);
  return failed == 0 || errno == EINVAL || errno == EROFS;  // pipes and the like have no disk
}

void syncFolderOf(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

WholeFile::WholeFile(std::filesystem::path path)
    : path_(std::move(path)), part_(path_.string() + ".part") {
  descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail(errno);
}

WholeFile::~WholeFile() {
  discard();
}

void WholeFile::discard() {
  if (descriptor_ < 0) return;
  ::close(std::exchange(descriptor_, -1));
  ::unlink(part_.c_str());
}

void WholeFile::fail(int reason) {
  discard();
  throw JobError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(reason)));
}

void WholeFile::write(std::span<const std::byte> bytes) {
  if (!writeAll(descriptor_, bytes)) fail(errno);
}

void WholeFile::finish() {
  if (!syncFile(descriptor_)) fail(errno);
  const int closed = ::close(std::exchange(descriptor_, -1));
  if (closed == 0 && ::rename(part_.c_str(), path_.c_str()) == 0) return syncFolderOf(path_);
  const int reason = errno;
  ::unlink(part_.c_str());
  fail(reason);
}

void writeFileWhole(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  WholeFile file(path);
  file.write(bytes);
  file.finish();
}

}  // namespace echocine
