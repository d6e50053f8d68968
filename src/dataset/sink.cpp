#include "dataset/sink.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>

#include "core/digest.h"
#include "core/error.h"
#include "core/file.h"
#include "video/cine_writer.h"
#include "video/dicom_writer.h"

namespace echocine::dataset {

namespace {

std::span<const std::byte> bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

std::filesystem::path Sink::place(const std::string& name) const {
  const std::filesystem::path path = folder_ / name;
  // A planted link to a folder would redirect the file; a link in the file's own place is
  // replaced by the rename.
  const std::filesystem::path within = std::filesystem::path(name).parent_path();
  if (const std::filesystem::path link = linkBelow(folder_, within); !link.empty())
    throw JobError(fmt::format("{}: is a link, a folder is needed: remove it", link.string()));
  makeFolder(path.parent_path());
  return path;
}

void Sink::write(const std::string& name, std::span<const std::byte> bytes) {
  writeFileWhole(place(name), bytes);
  files_[name] = {bytes.size(), digestOfBytes(bytes)};
}

void Sink::write(const std::string& name, std::string_view text) {
  write(name, bytesOf(text));
}

void Sink::writeCine(const std::string& name, std::span<const GreyImage* const> images,
                     double frame_rate_hz) {
  OutputSettings settings;
  settings.width = images.front()->width;
  settings.height = images.front()->height;
  const std::filesystem::path path = place(name);
  CineWriter writer(path, settings, frame_rate_hz);
  for (const GreyImage* image : images)
    writer.add(encodeCineFrame(*image, settings.codec, kJpegQuality));
  writer.finish();
  files_[name] = markOf(path).value_or(FileMark{});
}

void Sink::writeDicom(const std::string& name, std::span<const GreyImage* const> images,
                      const DicomLoop& header) {
  const std::filesystem::path path = place(name);
  DicomWriter writer(path, header);
  for (const GreyImage* image : images) writer.add(encodeDicomFrame(*image, header.scene.output));
  writer.finish();
  files_[name] = markOf(path).value_or(FileMark{});
}

std::optional<FileMark> markOf(const std::filesystem::path& path) {
  // A pipe that nobody fills would have us wait for ever.
  if (!isOrdinaryFile(path)) return std::nullopt;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return std::nullopt;
  FileMark mark;
  Digest digest;
  std::array<std::byte, 1 << 16> piece;  // a multiple of what the digest takes at once
  std::size_t filled = 0;
  ssize_t count = 0;
  do {
    count = ::read(descriptor, piece.data() + filled, piece.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count > 0) filled += static_cast<std::size_t>(count);
    if (filled == piece.size() || count == 0) {
      digest.update(std::span(piece).first(filled));
      mark.bytes += filled;
      filled = 0;
    }
  } while (count > 0 || (count < 0 && errno == EINTR));
  ::close(descriptor);
  if (count < 0) return std::nullopt;
  mark.digest = digest.hex();
  return mark;
}

}  // namespace echocine::dataset
