#include "zarr/zarr_input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>

#include "core/error.h"
#include "core/file.h"
#include "core/stop.h"
#include "zarr/zarr_codec.h"

namespace echocine {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostMetadata = std::size_t{16} << 20, kMostName = 300;

bool isFile(const fs::path& path) {
  std::error_code failed;
  return fs::is_regular_file(path, failed);
}

// Empty if there is none. A file of any size is refused before it is read.
bool readChunk(const fs::path& path, std::size_t most, std::vector<std::byte>& bytes) {
  std::error_code failed;
  const fs::file_status status = fs::symlink_status(path, failed);
  if (status.type() == fs::file_type::not_found) return false;
  if (status.type() != fs::file_type::regular)
    throw SceneError(fmt::format("{}: is no ordinary file", path.string()));
  const std::uintmax_t size = fs::file_size(path, failed);
  if (!failed && size > most)
    throw SceneError(fmt::format("{}: {} bytes are too many for its chunk", path.string(), size));
  bytes.resize(failed ? 0 : size);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (failed || static_cast<std::size_t>(in.gcount()) != bytes.size())
    throw SceneError(fmt::format("{}: cannot be read to its end", path.string()));
  return true;
}

// The place of a chunk: its part of the array, row by row along the last axis.
class ChunkPlace {
 public:
  ChunkPlace(const ZarrLayout& layout, const std::vector<std::size_t>& index)
      : layout_(layout), index_(index) {
    for (std::size_t a = 0; a < index.size(); ++a)
      size_.push_back(std::min(layout.chunk[a], layout.shape[a] - index[a] * layout.chunk[a]));
  }

  // Calls row(first value in the array, first value in the chunk, count) for each.
  template <typename Row>
  void forRows(const Row& row) const {
    const std::size_t last = size_.size() - 1;
    std::vector<std::size_t> at(size_.size(), 0);
    for (;;) {
      std::size_t to = 0, from = 0;
      for (std::size_t a = 0; a <= last; ++a) {
        to = to * layout_.shape[a] + index_[a] * layout_.chunk[a] + at[a];
        from = from * layout_.chunk[a] + at[a];
      }
      row(to, from, size_[last]);
      std::size_t axis = last;
      while (axis-- > 0 && ++at[axis] == size_[axis]) at[axis] = 0;
      if (axis == static_cast<std::size_t>(-1)) return;
    }
  }

 private:
  const ZarrLayout& layout_;
  const std::vector<std::size_t>& index_;
  std::vector<std::size_t> size_;
};

// The next index of a grid, the last axis first. False after the last.
bool advance(std::vector<std::size_t>& index, const std::vector<std::size_t>& grid) {
  for (std::size_t axis = index.size(); axis-- > 0;) {
    if (++index[axis] < grid[axis]) return true;
    index[axis] = 0;
  }
  return false;
}

std::string keyOfChunk(const ZarrLayout& layout, const std::vector<std::size_t>& index) {
  std::string key = layout.prefix;
  for (std::size_t a = 0; a < index.size(); ++a)
    key += (a == 0 ? "" : std::string(1, layout.separator)) + std::to_string(index[a]);
  return key;
}

template <typename Stored, typename T>
void copyRow(const std::vector<std::byte>& chunk, std::size_t from, std::size_t count, T* to) {
  for (std::size_t i = 0; i < count; ++i) {
    Stored value;
    std::memcpy(&value, chunk.data() + (from + i) * sizeof value, sizeof value);
    to[i] = static_cast<T>(value);
  }
}

template <typename T>
void place(const ZarrLayout& layout, const std::vector<std::size_t>& index,
           const std::vector<std::byte>& chunk, std::vector<T>& values) {
  ChunkPlace(layout, index).forRows([&](std::size_t to, std::size_t from, std::size_t count) {
    if (layout.type == ZarrType::uint8)
      copyRow<std::uint8_t>(chunk, from, count, values.data() + to);
    else if (layout.type == ZarrType::float32)
      copyRow<float>(chunk, from, count, values.data() + to);
    else
      copyRow<double>(chunk, from, count, values.data() + to);
  });
}

}  // namespace

bool isZarrStore(const fs::path& folder) {
  return isFile(folder / ".zgroup") || isFile(folder / "zarr.json");
}

ZarrInput::ZarrInput(fs::path folder) : folder_(std::move(folder)) {
  version_ = isFile(folder_ / "zarr.json") ? 3 : 2;
  const std::string name = version_ == 3 ? "zarr.json" : ".zgroup";
  const nlohmann::json group = zarrJson(text(name), (folder_ / name).string());
  if (!group.contains("zarr_format") || group["zarr_format"] != version_)
    throw SceneError(fmt::format("{}: zarr_format is not {}", (folder_ / name).string(), version_));
  if (version_ == 2 && isFile(folder_ / ".zattrs"))
    attributes_ = zarrJson(text(".zattrs"), (folder_ / ".zattrs").string());
  else if (version_ == 3 && group.contains("attributes"))
    attributes_ = group["attributes"];
  if (!attributes_.is_object()) attributes_ = nlohmann::json::object();
}

fs::path ZarrInput::inside(const std::string& name) const {
  const fs::path path(name);
  bool plain = !name.empty() && name.size() <= kMostName && path.is_relative();
  for (const fs::path& part : path)
    plain = plain && part != ".." && part != "." && !part.empty() &&
            part.string().find('\0') == std::string::npos;
  if (!plain)
    throw SceneError(
        fmt::format("{}: refers to an array outside it, or to none", folder_.string()));
  const fs::path link = linkBelow(folder_, path);
  if (!link.empty())
    throw SceneError(fmt::format("{}: is a link, accepted: files of the store", link.string()));
  return folder_ / path;
}

std::string ZarrInput::text(const fs::path& name) const {
  return readTextFile(inside(name.string()), kMostMetadata);
}

bool ZarrInput::has(const std::string& array) const {
  return isFile(inside(array) / (version_ == 2 ? ".zarray" : "zarr.json"));
}

ZarrLayout ZarrInput::layout(const std::string& array) const {
  const fs::path file = inside(array) / (version_ == 2 ? ".zarray" : "zarr.json");
  if (!isFile(file)) throw SceneError(fmt::format("{}: is absent", file.string()));
  return zarrLayout(text(fs::path(array) / file.filename()), version_, file.string());
}

template <typename T>
ZarrValues<T> ZarrInput::read(const std::string& array, const ZarrLayout& layout) const {
  const fs::path folder = inside(array);
  const std::size_t most = layout.chunkValues() * layout.valueBytes();
  ZarrValues<T> out{layout.shape, std::vector<T>(layout.values(), static_cast<T>(layout.fill)), 0};
  const std::vector<std::size_t> grid = layout.grid();
  std::vector<std::size_t> index(grid.size(), 0);
  do {
    checkpoint();
    const std::string key = keyOfChunk(layout, index);
    const fs::path file = inside((fs::path(array) / key).string());
    std::vector<std::byte> bytes;
    if (!readChunk(file, most + most / 64 + 4096, bytes)) {
      ++out.absent_chunks;
      continue;
    }
    place(layout, index, decodedChunk(layout, std::move(bytes), file.string()), out.values);
  } while (advance(index, grid));
  return out;
}

namespace {

void refuseLong(const fs::path& array, const ZarrLayout& layout, std::size_t most) {
  if (layout.values() > most)
    throw SceneError(
        fmt::format("{}: {} values, accepted: up to {}", array.string(), layout.values(), most));
}

}  // namespace

ZarrValues<std::uint8_t> ZarrInput::bytes(const std::string& array, std::size_t most) const {
  const ZarrLayout found = layout(array);
  if (found.type != ZarrType::uint8)
    throw SceneError(
        fmt::format("{}: holds no bytes, accepted: uint8", (folder_ / array).string()));
  if (!(found.fill >= 0 && found.fill <= 255))
    throw SceneError(fmt::format("{}: fill_value: is no byte", (folder_ / array).string()));
  refuseLong(folder_ / array, found, most);
  return read<std::uint8_t>(array, found);
}

ZarrValues<double> ZarrInput::numbers(const std::string& array, std::size_t most) const {
  const ZarrLayout found = layout(array);
  refuseLong(folder_ / array, found, most);
  return read<double>(array, found);
}

}  // namespace echocine
