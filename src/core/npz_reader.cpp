#include "core/npz_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>

#include "core/error.h"

namespace echocine {

namespace {

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::string_view kEnding = ".npy";
constexpr std::size_t kLongestHeader = 4096;  // for arrays of numbers. Our choice
constexpr std::size_t kMostDimensions = 32;   // NumPy's own limit before version 2

// The literal of a Python dict that is a .npy file's header.
class HeaderText {
 public:
  explicit HeaderText(std::string_view text) : left_(text) {}

  // Skips white space. Takes the token if it is next.
  bool take(std::string_view token) {
    const std::size_t begin = left_.find_first_not_of(" \t\r\n");
    left_.remove_prefix(std::min(begin, left_.size()));
    if (!left_.starts_with(token)) return false;
    left_.remove_prefix(token.size());
    return true;
  }
  void need(std::string_view token) {
    if (!take(token)) damaged();
  }
  std::string_view quoted() {
    const char* const quote = take("'") ? "'" : take("\"") ? "\"" : nullptr;
    if (quote == nullptr) return {};
    const std::size_t end = left_.find(quote);
    if (end == std::string_view::npos) damaged();
    const std::string_view text = left_.substr(0, end);
    left_.remove_prefix(end + 1);
    return text;
  }
  std::optional<std::size_t> number() {
    take("");
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(left_.data(), left_.data() + left_.size(), value);
    if (error == std::errc::result_out_of_range) damaged();
    if (error != std::errc{}) return std::nullopt;
    left_.remove_prefix(static_cast<std::size_t>(end - left_.data()));
    return value;
  }
  [[noreturn]] static void damaged() { throw SceneError("is no sound .npy array"); }

 private:
  std::string_view left_;
};

// "<f8": byte order, kind, bytes.
void readType(std::string_view type, NpyHeader& header) {
  const auto refuse = [&] {
    throw SceneError(fmt::format("has the type {}, accepted: integers, float32 or float64",
                                 type.empty() ? "of a record" : fmt::format("\"{}\"", type)));
  };
  if (type.size() != 3 || std::string_view("<>|=").find(type[0]) == std::string_view::npos)
    refuse();
  header.kind = type[1];
  header.item_bytes = static_cast<std::size_t>(type[2] - '0');
  const bool is_float = header.kind == 'f' && (type[2] == '4' || type[2] == '8');
  const bool is_integer = (header.kind == 'i' || header.kind == 'u') &&
                          (type[2] == '1' || type[2] == '2' || type[2] == '4' || type[2] == '8');
  if (!is_float && !is_integer) refuse();
  header.big_endian = type[0] == '>';
}

std::vector<std::size_t> readShape(HeaderText& text) {
  std::vector<std::size_t> shape;
  text.need("(");
  while (!text.take(")")) {
    const auto length = text.number();
    if (!length || shape.size() == kMostDimensions) HeaderText::damaged();
    shape.push_back(*length);
    if (!text.take(",")) {
      text.need(")");
      break;
    }
  }
  return shape;
}

// Number of values; none if it does not fit.
std::optional<std::size_t> countOf(const NpyHeader& header) {
  std::size_t count = 1;
  for (const std::size_t length : header.shape)
    if (__builtin_mul_overflow(count, length, &count)) return std::nullopt;
  return count;
}

template <typename T>
T valueAt(const std::byte* at, bool big_endian) {
  std::array<std::byte, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

// From Fortran order, in which the first index runs fastest, to C order.
template <typename To>
std::vector<To> inCOrder(const std::vector<To>& values, const std::vector<std::size_t>& shape) {
  std::vector<To> sorted(values.size());
  std::vector<std::size_t> index(shape.size(), 0);
  for (To& to : sorted) {
    std::size_t from = 0;
    for (std::size_t d = shape.size(); d-- > 0;) from = from * shape[d] + index[d];
    to = values[from];
    for (std::size_t d = shape.size(); d-- > 0;) {
      if (++index[d] < shape[d]) break;
      index[d] = 0;
    }
  }
  return sorted;
}

template <typename From, typename To>
void convert(std::span<const std::byte> data, bool big_endian, std::vector<To>& values) {
  if (std::is_same_v<From, To> && !big_endian) {
    std::memcpy(values.data(), data.data(), data.size());
    return;
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<To>(valueAt<From>(data.data() + i * sizeof(From), big_endian));
}

template <typename To>
std::vector<To> valuesOf(const NpyHeader& header, std::span<const std::byte> data) {
  std::vector<To> values(data.size() / header.item_bytes);
  const bool big = header.big_endian;
  const std::size_t bytes = header.item_bytes;
  if (header.kind == 'f')
    bytes == 4 ? convert<float>(data, big, values) : convert<double>(data, big, values);
  else if (header.kind == 'i')
    bytes == 1   ? convert<std::int8_t>(data, big, values)
    : bytes == 2 ? convert<std::int16_t>(data, big, values)
    : bytes == 4 ? convert<std::int32_t>(data, big, values)
                 : convert<std::int64_t>(data, big, values);
  else
    bytes == 1   ? convert<std::uint8_t>(data, big, values)
    : bytes == 2 ? convert<std::uint16_t>(data, big, values)
    : bytes == 4 ? convert<std::uint32_t>(data, big, values)
                 : convert<std::uint64_t>(data, big, values);
  return header.fortran_order && header.shape.size() > 1 ? inCOrder(values, header.shape) : values;
}

}  // namespace

NpyHeader npyHeader(std::span<const std::byte> file) {
  const std::string_view bytes(reinterpret_cast<const char*>(file.data()), file.size());
  if (!bytes.starts_with(kMagic) || bytes.size() < 12) HeaderText::damaged();
  const int version = bytes[6];
  if (version < 1 || version > 3) HeaderText::damaged();
  const std::size_t prefix = version == 1 ? 10 : 12;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, version == 1 ? 2 : 4);
  if (length > kLongestHeader || prefix + length > bytes.size()) HeaderText::damaged();
  HeaderText text(bytes.substr(prefix, length));
  NpyHeader header;
  header.data_at = prefix + length;
  int found = 0;
  text.need("{");
  while (!text.take("}")) {
    const std::string_view key = text.quoted();
    text.need(":");
    if (key == "descr") {
      readType(text.quoted(), header);
      found |= 1;
    } else if (key == "fortran_order") {
      header.fortran_order = text.take("True");
      if (!header.fortran_order) text.need("False");
      found |= 2;
    } else if (key == "shape") {
      header.shape = readShape(text);
      found |= 4;
    } else {
      HeaderText::damaged();
    }
    text.take(",");
  }
  if (found != 7) HeaderText::damaged();
  return header;
}

std::string shapeText(std::span<const std::size_t> shape) {
  return fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
}

NpzReader::NpzReader(std::filesystem::path file) : file_(std::move(file)) {
  try {
    zip_ = std::make_unique<const ZipReader>(file_);
  } catch (const SceneError& error) {
    fail(error.what());
  }
}

void NpzReader::fail(const std::string& what) const {
  throw SceneError(fmt::format("{}: {}", file_.string(), what));
}

std::vector<std::string> NpzReader::names() const {
  std::vector<std::string> names;
  for (const ZipEntry& entry : zip_->entries()) {
    names.push_back(entry.name);
    if (names.back().ends_with(kEnding)) names.back().resize(entry.name.size() - kEnding.size());
  }
  return names;
}

bool NpzReader::has(std::string_view array) const {
  const std::vector<std::string> all = names();
  return std::find(all.begin(), all.end(), array) != all.end();
}

const ZipEntry& NpzReader::entry(std::string_view array) const {
  const std::vector<std::string> all = names();
  const auto found = std::find(all.begin(), all.end(), array);
  if (found == all.end())
    fail(fmt::format("has no array \"{}\"; its arrays: {}", array,
                     all.empty() ? "none" : fmt::format("{}", fmt::join(all, ", "))));
  return zip_->entries()[static_cast<std::size_t>(found - all.begin())];
}

NpyHeader NpzReader::header(std::string_view array) const {
  const ZipEntry& found = entry(array);
  try {
    NpyHeader header = npyHeader(zip_->head(found, kLongestHeader + 12));
    const auto count = countOf(header);
    // Without overflow: an item has 8 bytes or fewer, and an archive fewer than 2^43 in all.
    if (!count || *count > found.whole || found.whole < header.data_at ||
        *count * header.item_bytes != found.whole - header.data_at)
      throw SceneError(
          fmt::format("has the shape {}, but {} bytes of data", shapeText(header.shape),
                      found.whole - std::min<std::uint64_t>(found.whole, header.data_at)));
    return header;
  } catch (const SceneError& error) {
    fail(fmt::format("{} {}", array, error.what()));
  }
}

std::vector<std::byte> NpzReader::content(std::string_view array, NpyHeader& header) const {
  header = this->header(array);
  try {
    return zip_->content(entry(array));
  } catch (const SceneError& error) {
    fail(error.what());
  }
}

std::vector<double> NpzReader::numbers(std::string_view array,
                                       std::vector<std::size_t>& shape) const {
  NpyHeader header;
  const std::vector<std::byte> bytes = content(array, header);
  shape = header.shape;
  return valuesOf<double>(header, std::span(bytes).subspan(header.data_at));
}

std::vector<std::int64_t> NpzReader::integers(std::string_view array,
                                              std::vector<std::size_t>& shape) const {
  NpyHeader header = this->header(array);
  if (header.kind == 'f') fail(fmt::format("{} has floats, accepted: integers", array));
  const std::vector<std::byte> bytes = content(array, header);
  shape = header.shape;
  return valuesOf<std::int64_t>(header, std::span(bytes).subspan(header.data_at));
}

}  // namespace echocine
