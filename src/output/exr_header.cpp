#include "output/exr_header.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "scene/channel.h"
#include "scene/limits.h"

namespace echocine {

namespace {

constexpr int kMaxSide = 1 << 16;

// https://openexr.com/en/latest/OpenEXRFileLayout.html: a magic number, the version in a byte and
// flags in three, then attributes (name 0, type 0, size, value) up to an empty name, all numbers
// little-endian. Flags: tiles, long names, deep data, several parts.
constexpr std::uint32_t kMagic = 20000630, kVersion = 2;

// The types of what ExrStack writes and their sizes; 0: any. The library goes by the type alone
// where its size is known, so another size would have it read on elsewhere than here.
constexpr std::array<std::pair<std::string_view, std::size_t>, 10> kTypes{{{"box2i", 16},
                                                                           {"chlist", 0},
                                                                           {"compression", 1},
                                                                           {"double", 8},
                                                                           {"float", 4},
                                                                           {"int", 4},
                                                                           {"lineOrder", 1},
                                                                           {"rational", 8},
                                                                           {"string", 0},
                                                                           {"v2f", 8}}};

bool isKnown(std::string_view type, std::size_t size) {
  return std::any_of(kTypes.begin(), kTypes.end(), [&](const auto& known) {
    return known.first == type && (known.second == 0 || known.second == size);
  });
}

// The unread bytes of the header.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : bytes_(bytes) {}

  template <typename Number>
  std::optional<Number> number() {
    Number value{};
    if (bytes_.size() < sizeof value) return std::nullopt;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }
  std::optional<std::string_view> text() {
    const std::size_t end = bytes_.find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view found = bytes_.substr(0, end);
    bytes_.remove_prefix(end + 1);
    return found;
  }
  bool atEnd() const { return bytes_.empty(); }
  std::optional<std::string_view> take(std::size_t size) {
    if (bytes_.size() < size) return std::nullopt;
    const std::string_view found = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return found;
  }

 private:
  std::string_view bytes_;
};

// A window from (0, 0), not larger than a scene's lines and samples may be.
bool isSmallWindow(std::string_view value) {
  std::array<std::int32_t, 4> window{};
  if (value.size() != sizeof window) return false;
  std::memcpy(window.data(), value.data(), sizeof window);
  const auto [left, top, right, bottom] = window;
  return left == 0 && top == 0 && right >= 0 && bottom >= 0 && right < kMaxSide &&
         bottom < kMaxSide &&
         (std::int64_t{right} + 1) * (std::int64_t{bottom} + 1) <= kMaxPolarSamples;
}

// No more channels than there are to write; each has a name and 16 bytes.
bool isShortChannelList(std::string_view value) {
  Cursor list(value);
  for (std::size_t count = 0; count <= kAllChannels.size() + kTruthChannels.size(); ++count) {
    const std::optional<std::string_view> name = list.text();
    if (!name) return false;
    if (name->empty()) return list.atEnd();
    if (!list.take(16)) return false;
  }
  return false;
}

// No flag is set: no tiles, no long names, no deep data, one part. A header that does not end
// within the bytes is none.
bool isPlain(std::string_view bytes) {
  Cursor header(bytes);
  if (header.number<std::uint32_t>() != kMagic || header.number<std::uint32_t>() != kVersion)
    return false;
  while (const std::optional<std::string_view> name = header.text()) {
    if (name->empty()) return true;
    const std::optional<std::string_view> type = header.text();
    const std::optional<std::uint32_t> size = header.number<std::uint32_t>();
    if (!type || !size) return false;
    const std::optional<std::string_view> value = header.take(*size);
    if (!value || !isKnown(*type, *size)) return false;
    if (*type == "box2i" && !isSmallWindow(*value)) return false;
    if (*type == "chlist" && !isShortChannelList(*value)) return false;
  }
  return false;
}

}  // namespace

bool hasPlainExrHeader(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file && errno == ENOMEM) throw std::bad_alloc();
  std::string bytes(kMaxHeaderBytes, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return isPlain(std::string_view(bytes).substr(0, static_cast<std::size_t>(file.gcount())));
}

}  // namespace echocine
