#pragma once
// POSIX tar archives (IEEE Std 1003.1, pax, ustar interchange format), with deterministic bytes.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "core/file.h"

namespace echocine::dataset {

// Size of a file in an archive: its header, and its content in whole blocks.
std::uint64_t ustarBytes(std::uint64_t file_bytes);

// Files have mode 0644, owner 0 and time 0. Written under a temporary name and renamed by finish().
class UstarFile {
 public:
  explicit UstarFile(const std::filesystem::path& path) : file_(path) {}  // throws JobError

  // Precondition: the name has at most 100 bytes. Throws JobError from 8 GiB on.
  void add(std::string_view name, std::span<const std::byte> bytes);
  void finish();
  std::uint64_t bytes() const { return bytes_; }  // so far

 private:
  void write(std::span<const std::byte> bytes);
  WholeFile file_;
  std::uint64_t bytes_ = 0;
};

}  // namespace echocine::dataset
