#include "core/zip_reader.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>
#include <new>
#include <span>

#include "core/error.h"

namespace echocine {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t kLocalBytes = 30, kEntryBytes = 46, kEndBytes = 22;
constexpr std::uint64_t kLongestComment = 65535;
// No deflated byte stands for more bytes than this.
constexpr std::uint64_t kMostInflation = 1032;

// A number in little endian. Precondition: the bytes are there.
template <typename T>
T numberAt(std::span<const std::byte> bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

[[noreturn]] void failDamaged(const std::string& what) {
  throw SceneError("is no sound zip archive: " + what);
}

// Inflates into `whole` bytes or fewer. Returns the number made.
std::size_t inflated(std::span<const std::byte> packed, std::span<std::byte> whole, bool complete) {
  z_stream stream{};
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
  // zlib counts in 32 bits; archives are below 4 GiB.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(whole.data());
  stream.avail_out = static_cast<uInt>(whole.size());
  const int result = inflate(&stream, complete ? Z_FINISH : Z_SYNC_FLUSH);
  const std::size_t made = whole.size() - stream.avail_out;
  inflateEnd(&stream);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  if (result != Z_STREAM_END && (complete || (result != Z_OK && result != Z_BUF_ERROR)))
    failDamaged("its compressed data is damaged");
  return made;
}

// The record at the archive's end. `tail`: the last bytes of the archive.
std::size_t endRecordIn(std::span<const std::byte> tail) {
  for (std::size_t back = kEndBytes; back <= tail.size(); ++back) {
    const std::size_t at = tail.size() - back;
    if (numberAt<std::uint32_t>(tail, at) == 0x06054b50 &&
        at + kEndBytes + numberAt<std::uint16_t>(tail, at + 20) <= tail.size())
      return at;
  }
  failDamaged("its directory is missing");
}

}  // namespace

ZipReader::ZipReader(const std::filesystem::path& file) {
  descriptor_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor_ < 0 && errno == ENOMEM) throw std::bad_alloc();
  if (descriptor_ < 0) throw SceneError(fmt::format("cannot be opened: {}", std::strerror(errno)));
  try {
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0 || !S_ISREG(status.st_mode))
      throw SceneError("is not a regular file");
    size_ = static_cast<std::uint64_t>(status.st_size);
    if (size_ >= 0xffffffffu)
      throw SceneError("is larger than 4 GiB, the limit of zip archives without ZIP64");
    readDirectory();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

ZipReader::~ZipReader() {
  ::close(descriptor_);
}

std::vector<std::byte> ZipReader::bytesAt(std::uint64_t at, std::uint64_t count) const {
  if (at > size_ || count > size_ - at) failDamaged("it is cut short");
  std::vector<std::byte> bytes(count);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t read = ::pread(descriptor_, bytes.data() + done, bytes.size() - done,
                                 static_cast<off_t>(at + done));
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) throw SceneError(fmt::format("reading failed: {}", std::strerror(errno)));
    if (read == 0) failDamaged("it became shorter while it was read");
    done += static_cast<std::size_t>(read);
  }
  return bytes;
}

void ZipReader::readDirectory() {
  const std::uint64_t tail_bytes = std::min(size_, kEndBytes + kLongestComment);
  const std::vector<std::byte> tail = bytesAt(size_ - tail_bytes, tail_bytes);
  const std::span<const std::byte> end = std::span(tail).subspan(endRecordIn(tail));
  const auto count = numberAt<std::uint16_t>(end, 10);
  const auto bytes = numberAt<std::uint32_t>(end, 12), start = numberAt<std::uint32_t>(end, 16);
  if (count == 0xffff || start == 0xffffffffu)
    throw SceneError("is a ZIP64 archive, accepted: one of less than 4 GiB");
  const std::vector<std::byte> directory = bytesAt(start, bytes);
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (directory.size() - at < kEntryBytes || numberAt<std::uint32_t>(directory, at) != 0x02014b50)
      failDamaged("its directory is damaged");
    const auto number16 = [&](std::size_t offset) {
      return numberAt<std::uint16_t>(directory, at + offset);
    };
    const auto number32 = [&](std::size_t offset) {
      return numberAt<std::uint32_t>(directory, at + offset);
    };
    const std::size_t name_bytes = number16(28);
    const std::size_t entry_bytes = kEntryBytes + name_bytes + number16(30) + number16(32);
    if (directory.size() - at < entry_bytes) failDamaged("its directory is damaged");
    ZipEntry entry;
    entry.name.assign(reinterpret_cast<const char*>(directory.data()) + at + kEntryBytes,
                      name_bytes);
    if (number16(8) & 1) throw SceneError("is encrypted, accepted: an archive without a password");
    const auto method = number16(10);
    if (method != 0 && method != 8)
      throw SceneError(
          fmt::format("is compressed by method {}, accepted: stored or deflate", method));
    entry.deflated = method == 8;
    entry.crc = number32(16);
    entry.packed = number32(20);
    entry.whole = number32(24);
    entry.header_at = number32(42);
    if (entry.packed > size_ || entry.header_at > size_ ||
        (entry.deflated ? entry.whole > kMostInflation * (entry.packed + 1)
                        : entry.whole != entry.packed))
      failDamaged("a size in its directory is impossible");
    entries_.push_back(std::move(entry));
    at += entry_bytes;
  }
}

std::uint64_t ZipReader::dataAt(const ZipEntry& entry) const {
  const std::vector<std::byte> header = bytesAt(entry.header_at, kLocalBytes);
  if (numberAt<std::uint32_t>(header, 0) != 0x04034b50) failDamaged("an entry is damaged");
  return entry.header_at + kLocalBytes + numberAt<std::uint16_t>(header, 26) +
         numberAt<std::uint16_t>(header, 28);
}

std::vector<std::byte> ZipReader::content(const ZipEntry& entry) const {
  std::vector<std::byte> whole = bytesAt(dataAt(entry), entry.packed);
  if (entry.deflated) {
    const std::vector<std::byte> packed = std::move(whole);
    whole = std::vector<std::byte>(entry.whole);
    if (inflated(packed, whole, true) != entry.whole)
      failDamaged("an entry is shorter than its directory states");
  }
  const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(whole.data()), whole.size());
  if (static_cast<std::uint32_t>(crc) != entry.crc)
    failDamaged("the checksum of an entry is wrong");
  return whole;
}

std::vector<std::byte> ZipReader::head(const ZipEntry& entry, std::size_t most) const {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(entry.whole, most));
  if (!entry.deflated) return bytesAt(dataAt(entry), count);
  // Deflated data is at most a few bytes longer than its content.
  const std::vector<std::byte> packed =
      bytesAt(dataAt(entry), std::min<std::uint64_t>(entry.packed, 2 * count + 1024));
  std::vector<std::byte> whole(count);
  whole.resize(inflated(packed, whole, false));
  return whole;
}

}  // namespace echocine
