#include "video/read_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>

#include "core/error.h"
#include "video/libav_reader.h"
#include "video/video_builder.h"

namespace echocine {

namespace {

// A file of any size is refused before it is read.
std::vector<std::byte> fileBytes(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream in(path, std::ios::binary);
  if (error || !in)
    throw SceneError(
        fmt::format("{}: cannot be read; give a video file, a DICOM file, or a folder "
                    "of PNG or JPEG frames",
                    path.string()));
  if (size > kMaxFileBytes)
    throw SceneError(fmt::format("{}: larger than {} bytes; give a shorter part of it",
                                 path.string(), kMaxFileBytes));
  std::vector<std::byte> bytes(size);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size)
    throw SceneError(fmt::format("{}: cannot be read to its end", path.string()));
  return bytes;
}

// Lower case, for cameras write .JPG.
std::string extensionOf(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

// Digits count by value, so frame_10 comes after frame_9.
bool namesInOrder(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (digit(a[i]) && digit(b[j])) {
      const auto number = [&](const std::string& s, std::size_t& at) {
        while (at < s.size() && s[at] == '0') ++at;
        const std::size_t start = at;
        while (at < s.size() && digit(s[at])) ++at;
        return s.substr(start, at - start);
      };
      const std::string m = number(a, i), n = number(b, j);
      if (m.size() != n.size()) return m.size() < n.size();
      if (m != n) return m < n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

Video readSequence(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    const std::string extension = extensionOf(entry.path());
    std::error_code dangling;
    // Names that begin with a dot are hidden: file systems keep attributes in such files.
    if (entry.is_regular_file(dangling) && !entry.path().filename().string().starts_with('.') &&
        (extension == ".png" || extension == ".jpg" || extension == ".jpeg"))
      files.push_back(entry.path());
  }
  if (failed)
    throw SceneError(fmt::format("{}: cannot be read: {}", folder.string(), failed.message()));
  if (files.empty())
    throw SceneError(
        fmt::format("{}: holds neither a render's manifest.json nor PNG or JPEG "
                    "frames; give such a folder, or a video file",
                    folder.string()));
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    const std::string x = a.filename().string(), y = b.filename().string();
    return namesInOrder(x, y) || (!namesInOrder(y, x) && x < y);  // 01 and 1: by their text
  });
  VideoBuilder builder(folder.string());
  for (const std::filesystem::path& file : files) {
    builder.video().name = file.string();
    readByLibav(fileBytes(file), builder);
  }
  builder.video().name = folder.string();
  builder.video().format = "sequence of pictures";
  builder.video().rate = {};
  return builder.finish();
}

}  // namespace

// The mark of PS3.10: files without it, from before 1993, are not read.
bool looksLikeDicom(std::span<const std::byte> bytes) {
  return bytes.size() > 132 && std::memcmp(bytes.data() + 128, "DICM", 4) == 0;
}

Video readVideoBytes(const std::string& name, std::span<const std::byte> bytes) {
  if (looksLikeDicom(bytes)) return readDicom(name, bytes);
  VideoBuilder builder(name);
  readByLibav(bytes, builder);
  if (builder.video().frames.size() == 1)
    throw SceneError(
        fmt::format("{}: is a still image, or a video that ends after one frame; give a loop of at "
                    "least two frames, better a whole beat, or the folder of all its frames",
                    name));
  return builder.finish();
}

Video readVideo(const std::filesystem::path& path) {
  std::error_code failed;  // such as a link to itself
  if (std::filesystem::is_directory(path, failed)) return readSequence(path);
  if (!std::filesystem::is_regular_file(path, failed))
    throw SceneError(
        fmt::format("{}: there is no such file; give a video file, a DICOM file, or a "
                    "folder of PNG or JPEG frames",
                    path.string()));
  return readVideoBytes(path.string(), fileBytes(path));
}

}  // namespace echocine
