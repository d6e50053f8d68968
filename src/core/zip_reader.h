#pragma once
// Files in a zip archive on disk. Stored and deflated entries; no encryption, no ZIP64.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace echocine {

struct ZipEntry {
  std::string name;
  bool deflated = false;
  std::uint32_t crc = 0;
  std::uint64_t packed = 0, whole = 0;  // bytes in the archive, and after inflation
  std::uint64_t header_at = 0;          // of its local header
};

// Every declared size is checked against the size of the archive before memory is taken for it.
// All functions throw SceneError, without the archive's name, for a damaged archive.
class ZipReader {
 public:
  // Reads the archive's directory. Throws SceneError if the file cannot be opened.
  explicit ZipReader(const std::filesystem::path& file);
  ~ZipReader();
  ZipReader(const ZipReader&) = delete;
  ZipReader& operator=(const ZipReader&) = delete;

  const std::vector<ZipEntry>& entries() const { return entries_; }

  // The content of an entry. Its CRC-32 is verified. Thread-safe.
  std::vector<std::byte> content(const ZipEntry& entry) const;

  // The first bytes of the content, at most `most`, unverified. Thread-safe.
  std::vector<std::byte> head(const ZipEntry& entry, std::size_t most) const;

 private:
  std::vector<std::byte> bytesAt(std::uint64_t at, std::uint64_t count) const;
  std::uint64_t dataAt(const ZipEntry& entry) const;
  void readDirectory();

  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::vector<ZipEntry> entries_;
};

}  // namespace echocine
