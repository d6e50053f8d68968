#include "dataset/ustar.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "core/check.h"
#include "core/error.h"

namespace echocine::dataset {

namespace {

constexpr std::uint64_t kBlock = 512;
constexpr std::uint64_t kArchive = 20 * kBlock;         // an archive is a multiple of that
constexpr std::uint64_t kMostBytes = (1ULL << 33) - 1;  // eleven octal digits

using Header = std::array<char, kBlock>;

void put(Header& header, std::size_t at, std::string_view text) {
  std::memcpy(header.data() + at, text.data(), text.size());
}

// Offsets and widths are the standard's own.
Header headerOf(std::string_view name, std::uint64_t bytes) {
  constexpr std::size_t kName = 0, kMode = 100, kOwner = 108, kGroup = 116, kSize = 124,
                        kTime = 136, kSum = 148, kType = 156, kMagic = 257, kMajor = 329,
                        kMinor = 337;
  Header header{};
  put(header, kName, name);
  put(header, kMode, "0000644");
  put(header, kOwner, "0000000");
  put(header, kGroup, "0000000");
  put(header, kSize, fmt::format("{:011o}", bytes));
  put(header, kTime, "00000000000");
  put(header, kSum, "        ");  // counts as spaces in the sum
  put(header, kType, "0");
  put(header, kMagic,
      std::string_view("ustar\0"
                       "00",
                       8));
  put(header, kMajor, "0000000");
  put(header, kMinor, "0000000");
  unsigned sum = 0;
  for (const char c : header) sum += static_cast<unsigned char>(c);
  put(header, kSum, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
  return header;
}

std::uint64_t upTo(std::uint64_t bytes, std::uint64_t multiple) {
  return (bytes + multiple - 1) / multiple * multiple;
}

}  // namespace

std::uint64_t ustarBytes(std::uint64_t file_bytes) {
  return kBlock + upTo(file_bytes, kBlock);
}

void UstarFile::write(std::span<const std::byte> bytes) {
  file_.write(bytes);
  bytes_ += bytes.size();
}

void UstarFile::add(std::string_view name, std::span<const std::byte> bytes) {
  constexpr std::size_t kLongestName = 100;
  CHECK_LE(name.size(), kLongestName);
  if (bytes.size() > kMostBytes) throw JobError(fmt::format("{}: over 8 GiB for a tar", name));
  const Header header = headerOf(name, bytes.size());
  write(std::as_bytes(std::span(header)));
  write(bytes);
  write(std::vector<std::byte>(upTo(bytes_, kBlock) - bytes_));
}

// Two blocks of zeros end it.
void UstarFile::finish() {
  write(std::vector<std::byte>(upTo(bytes_ + 2 * kBlock, kArchive) - bytes_));
  file_.finish();
}

}  // namespace echocine::dataset
