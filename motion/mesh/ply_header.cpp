#include "motion/mesh/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <vector>

#include "core/error.h"

namespace echocine {

namespace {

constexpr std::array<std::string_view, 12> kIntegers{"char",  "uchar",  "short", "ushort",
                                                     "int",   "uint",   "int8",  "uint8",
                                                     "int16", "uint16", "int32", "uint32"};
constexpr std::array<std::string_view, 4> kReals{"float", "double", "float32", "float64"};
constexpr std::array<std::string_view, 3> kFormats{"ascii", "binary_little_endian",
                                                   "binary_big_endian"};

template <std::size_t N>
bool isOneOf(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool isScalar(std::string_view type) {
  return isOneOf(kIntegers, type) || isOneOf(kReals, type);
}

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    words.push_back(line.substr(0, line.find_first_of(" \t\r")));
    line.remove_prefix(words.back().size());
  }
}

class HeaderCheck {
 public:
  explicit HeaderCheck(std::size_t file_size) : file_size_(file_size) {}

  // False if the line is invalid at its position.
  bool accepts(const std::vector<std::string_view>& words) {
    if (words[0] == "comment" || words[0] == "obj_info") return true;
    if (words[0] == "format") return acceptsFormat(words);
    if (words[0] == "element") return has_format_ && acceptsElement(words);
    return words[0] == "property" && acceptsProperty(words);
  }

  bool isComplete() const { return coordinates_ == 3 && has_indices_; }

 private:
  bool acceptsFormat(const std::vector<std::string_view>& words) {
    const bool is_first = !has_format_;
    has_format_ = true;
    return is_first && words.size() == 3 && isOneOf(kFormats, words[1]) && words[2] == "1.0";
  }

  bool acceptsElement(const std::vector<std::string_view>& words) {
    if (words.size() != 3) return false;
    std::size_t count = 0;
    const std::string_view number = words[2];
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), count);
    if (error != std::errc{} || end != number.data() + number.size()) return false;
    element_ = words[1];
    return count <= file_size_ && (element_ != "face" || coordinates_ == 3);
  }

  bool acceptsProperty(const std::vector<std::string_view>& words) {
    if (element_.empty()) return false;
    if (words.size() == 5 && words[1] == "list") {
      const bool is_indices = words[4] == "vertex_indices" || words[4] == "vertex_index";
      const bool is_known = isOneOf(kIntegers, words[2]) && isOneOf(kIntegers, words[3]);
      const bool is_wanted = element_ == "face" && is_indices && is_known && !has_indices_;
      const bool is_after_faces =
          element_ != "face" && has_indices_;  // a list there would be ignored
      has_indices_ = has_indices_ || is_wanted;
      return is_wanted || is_after_faces;
    }
    if (words.size() != 3 || !isScalar(words[1])) return false;
    const bool is_coordinate = words[2] == "x" || words[2] == "y" || words[2] == "z";
    if (element_ == "vertex" && is_coordinate) {
      ++coordinates_;
      return isOneOf(kReals, words[1]);
    }
    return true;
  }

  std::size_t file_size_;
  std::string element_;
  int coordinates_ = 0;
  bool has_format_ = false;
  bool has_indices_ = false;
};

}  // namespace

void checkPlyHeader(std::string_view bytes) {
  HeaderCheck header(bytes.size());
  for (std::size_t line_number = 1; !bytes.empty(); ++line_number) {
    const std::size_t end = bytes.find('\n');
    const std::vector<std::string_view> words = wordsOf(bytes.substr(0, end));
    bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
    if (line_number == 1) {
      if (words.size() == 1 && words[0] == "ply") continue;
      throw SceneError("is not a PLY file: its first line must be \"ply\"");
    }
    if (words.size() == 1 && words[0] == "end_header") {
      if (header.isComplete()) return;
      break;
    }
    if (words.empty() || !header.accepts(words))
      throw SceneError(fmt::format(
          "line {} of the header cannot be used; a PLY 1.0 header is accepted with float vertices "
          "x, y, z and then faces with one integer list vertex_indices",
          line_number));
  }
  throw SceneError("the header lacks vertices x, y, z, faces vertex_indices, or its end");
}

}  // namespace echocine
