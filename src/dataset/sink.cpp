#include "dataset/sink.h"

#include <array>
#include <fstream>

#include "core/digest.h"
#include "core/file.h"
#include "video/cine_writer.h"

namespace echocine::dataset {

namespace {

std::span<const std::byte> bytesOf(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

std::filesystem::path Sink::place(const std::string& name) const {
  const std::filesystem::path path = folder_ / name;
  makeFolder(path.parent_path());
  return path;
}

void Sink::write(const std::string& name, std::span<const std::byte> bytes) {
  writeFileWhole(place(name), bytes);
  Digest digest;
  digest.update(bytes);
  files_[name] = {bytes.size(), digest.hex()};
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

std::optional<FileMark> markOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  FileMark mark;
  Digest digest;
  std::array<char, 1 << 16> piece;  // a multiple of what the digest takes at once
  while (file.read(piece.data(), piece.size()), file.gcount() > 0) {
    const auto count = static_cast<std::size_t>(file.gcount());
    digest.update(std::as_bytes(std::span(piece.data(), count)));
    mark.bytes += count;
  }
  if (file.bad()) return std::nullopt;
  mark.digest = digest.hex();
  return mark;
}

}  // namespace echocine::dataset
