#include "motion/mesh/obj_reader.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "core/error.h"
#include "motion/mesh/obj_tags.h"
#include "motion/mesh/obj_words.h"

namespace echocine {

namespace {

class ObjParser {
 public:
  TriangleMesh parse(std::string_view text) {
    std::string joined;  // of lines continued by a backslash
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      std::string_view line = text.substr(0, end);
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      ++line_number_;
      if (line.ends_with('\r')) line.remove_suffix(1);
      const bool is_continued = line.ends_with('\\') && line.find('#') == line.npos;
      if (is_continued) {
        joined.append(line.substr(0, line.size() - 1)).append(" ");
      } else if (joined.empty()) {
        statement(line);
      } else {
        statement(joined.append(line));
        joined.clear();
      }
    }
    if (!joined.empty()) statement(joined);
    tags_.joinTo(mesh_);
    return std::move(mesh_);
  }

 private:
  void statement(std::string_view line) {
    line = line.substr(0, line.find('#'));
    const std::string_view keyword = nextWord(line);
    if (keyword == "v") vertex(line);
    if (keyword == "f") face(line);
    if (keyword == "t") tags_.read(line, line_number_);
  }

  // Further numbers (a weight, a colour) are ignored.
  void vertex(std::string_view line) {
    Vec3d position;
    for (double* coordinate : {&position.x, &position.y, &position.z}) {
      const std::string_view word = nextWord(line);
      if (!parseNumber(word, *coordinate))
        fail(fmt::format("vertex {} has '{}' where a coordinate is needed",
                         mesh_.positions.size() + 1, word));
    }
    if (mesh_.positions.size() == kMaxMeshVertices)
      fail(fmt::format("more than {} vertices", kMaxMeshVertices));
    mesh_.positions.push_back(position);
  }

  void face(std::string_view line) {
    corners_.clear();
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line))
      corners_.push_back(corner(word.substr(0, word.find('/'))));
    ++face_count_;
    if (corners_.size() < 3)
      fail(fmt::format("face {} has {} corners, at least 3 are needed", face_count_,
                       corners_.size()));
    if (mesh_.triangles.size() + corners_.size() > kMaxMeshTriangles)
      fail(fmt::format("more than {} triangles", kMaxMeshTriangles));
    appendFan(corners_, face_count_ - 1, mesh_);
  }

  std::uint32_t corner(std::string_view word) const {
    std::int64_t number = 0;
    if (!parseNumber(word, number))
      fail(fmt::format("face {} has '{}' where a vertex number is needed", face_count_ + 1, word));
    const auto vertex_count = static_cast<std::int64_t>(mesh_.positions.size());
    const std::int64_t index = number < 0 ? vertex_count + number : number - 1;
    if (index < 0 || index >= static_cast<std::int64_t>(kMaxMeshVertices))
      fail(fmt::format("face {} uses vertex {}; numbers start at 1", face_count_ + 1, number));
    return static_cast<std::uint32_t>(index);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw SceneError(fmt::format("{}: {}", line_number_, what));
  }

  TriangleMesh mesh_;
  ObjTags tags_;
  std::vector<std::uint32_t> corners_;
  std::size_t line_number_ = 0;
  std::size_t face_count_ = 0;
};

}  // namespace

TriangleMesh parseObj(std::string_view text) {
  return ObjParser().parse(text);
}

}  // namespace echocine
