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
#include "core/file_target.h"

namespace echocine {

std::string readTextFile(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed))
    throw SceneError(fmt::format("{}: is a folder, a file is needed", path.string()));
  // A pipe that nobody fills would have us wait for ever.
  if (std::filesystem::exists(path, failed) && !std::filesystem::is_regular_file(path, failed))
    throw SceneError(fmt::format("{}: is not a regular file", path.string()));
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
    throw JobError(fmt::format("{}: cannot be created: {}", folder.string(), error.message()));
}

bool syncFile(int descriptor) {
  int failed = 0;
  do failed = ::fsync(descriptor);
  while (failed != 0 && errno == EINTR);
  return failed == 0 || errno == EINVAL || errno == EROFS;  // pipes and the like have no disk
}

void syncFolderOf(const std::filesystem::path& path) {
  const std::filesystem::path folder = folderOf(path);
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

WholeFile::WholeFile(std::filesystem::path path) : path_(std::move(path)), part_(makePart(path_)) {
  if (part_.descriptor < 0) fail(errno);
}

WholeFile::~WholeFile() {
  discard();
}

void WholeFile::discard() {
  if (part_.descriptor < 0) return;
  ::close(std::exchange(part_.descriptor, -1));
  ::unlink(part_.name.c_str());
}

void WholeFile::fail(int reason) {
  discard();
  failWriting(path_, reason);
}

void WholeFile::write(std::span<const std::byte> bytes) {
  if (!writeAll(part_.descriptor, bytes)) fail(errno);
}

// On the disk, under its part's name.
void WholeFile::close() {
  if (!syncFile(part_.descriptor)) fail(errno);
  if (::close(std::exchange(part_.descriptor, -1)) == 0) return;
  const int reason = errno;
  ::unlink(part_.name.c_str());
  fail(reason);
}

void WholeFile::finish() {
  close();
  if (::rename(part_.name.c_str(), path_.c_str()) == 0) return syncFolderOf(path_);
  const int reason = errno;
  ::unlink(part_.name.c_str());
  fail(reason);
}

// A link fails where the name is taken. File systems without links get a rename: then the last of
// two writers wins.
bool WholeFile::finishOnce() {
  close();
  const bool linked = ::link(part_.name.c_str(), path_.c_str()) == 0;
  const int reason = linked ? 0 : errno;
  if (reason == EPERM || reason == EOPNOTSUPP || reason == EMLINK) {
    if (::rename(part_.name.c_str(), path_.c_str()) == 0) return syncFolderOf(path_), true;
  }
  ::unlink(part_.name.c_str());
  if (!linked && reason != EEXIST) fail(reason);
  syncFolderOf(path_);
  return linked;
}

bool isOrdinaryFile(const std::filesystem::path& path) {
  std::error_code failed;
  return std::filesystem::symlink_status(path, failed).type() ==
         std::filesystem::file_type::regular;
}

std::filesystem::path linkBelow(const std::filesystem::path& folder,
                                const std::filesystem::path& name) {
  std::filesystem::path at = folder;
  std::error_code failed;
  for (const std::filesystem::path& part : name) {
    at /= part;
    if (std::filesystem::is_symlink(std::filesystem::symlink_status(at, failed))) return at;
  }
  return {};
}

bool writeFileOnce(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  WholeFile file(path);
  file.write(bytes);
  return file.finishOnce();
}

void writeNewFile(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const int descriptor =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (descriptor < 0) failWriting(path, errno);
  const int reason = writeAll(descriptor, bytes) ? 0 : errno;
  if (::close(descriptor) != 0 && reason == 0) failWriting(path, errno);
  if (reason != 0) failWriting(path, reason);
}

std::string writePart(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const PartFile part = makePart(path);
  int reason = part.descriptor < 0 ? errno : 0;
  if (reason == 0 && !writeAll(part.descriptor, bytes)) reason = errno;
  if (part.descriptor >= 0 && ::close(part.descriptor) != 0 && reason == 0) reason = errno;
  if (reason == 0) return part.name;
  if (part.descriptor >= 0) ::unlink(part.name.c_str());
  failWriting(path, reason);
}

void syncAllOf(const std::filesystem::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  int reason = descriptor < 0 ? errno : 0;
  if (descriptor >= 0 && ::syncfs(descriptor) != 0) reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (reason != 0 && reason != EROFS) failWriting(folder, reason);
}

void writeFileWhole(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  WholeFile file(path);
  file.write(bytes);
  file.finish();
}

}  // namespace echocine
