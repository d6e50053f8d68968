#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace echocine {

std::string readTextFile(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code failed;
  if (std::filesystem::is_directory(path, failed))
    throw SceneError(fmt::format("{}: is a folder, a file is needed", path.string()));
  std::ifstream file(path, std::ios::binary);
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

void writeFileWhole(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  const std::string part = path.string() + ".part";
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  bool good = descriptor >= 0;
  int reason = errno;
  if (good) {
    good = writeAll(descriptor, bytes);
    reason = errno;
    if (::close(descriptor) != 0 && good) {
      good = false;
      reason = errno;
    }
    if (good && ::rename(part.c_str(), path.c_str()) != 0) {
      good = false;
      reason = errno;
    }
    if (!good) ::unlink(part.c_str());
  }
  if (!good)
    throw JobError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(reason)));
}

}  // namespace echocine
