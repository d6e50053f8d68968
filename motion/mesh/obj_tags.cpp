#include "motion/mesh/obj_tags.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_set>
#include <utility>

#include "core/error.h"
#include "motion/mesh/obj_words.h"
#include "motion/mesh/settle_tags.h"

namespace echocine {

namespace {

constexpr const char* kAccepted =
    "accepted: t crease 2/1/0 v0 v1 sharpness, t corner 1/1/0 v sharpness";

[[noreturn]] void fail(std::size_t line, const std::string& what) {
  throw SceneError(fmt::format("{}: {}", line, what));
}

std::uint32_t readVertex(std::string_view& rest, std::size_t line) {
  const std::string_view word = nextWord(rest);
  std::uint32_t vertex = 0;
  if (!parseNumber(word, vertex))
    fail(line, fmt::format("the tag has '{}' where a vertex number, from 0, is needed; {}", word,
                           kAccepted));
  return vertex;
}

float readSharpness(std::string_view& rest, std::size_t line) {
  const std::string_view word = nextWord(rest);
  double sharpness = 0;
  if (!parseNumber(word, sharpness))
    fail(line, fmt::format("the tag has '{}' where a sharpness is needed; {}", word, kAccepted));
  if (!(sharpness >= 0))
    fail(line, fmt::format("sharpness {} is not accepted: 0 (smooth) and up, 10 and more are "
                           "infinitely sharp",
                           word));
  return static_cast<float>(std::min(sharpness, double{kInfiniteSharpness}));
}

void expectWord(std::string_view& rest, std::string_view wanted, std::size_t line) {
  const std::string_view word = nextWord(rest);
  if (word != wanted)
    fail(line, fmt::format("the tag has '{}' where '{}' is needed; {}", word, wanted, kAccepted));
}

// Merges duplicates of equal sharpness and drops smooth tags. Tags are in the order of their lines;
// `name` names one for the message.
template <typename Named, typename Tag, typename Name>
void settle(std::vector<Named>& named, Tag&& tag, Name&& name) {
  settleTags(named, tag, [&](const Named& first, const Named& second) {
    fail(second.line,
         fmt::format("{} has sharpness {:g} here and {:g} in line {}; one is accepted",
                     name(second), tag(second).sharpness, tag(first).sharpness, first.line));
  });
  std::erase_if(named, [&](const Named& entry) { return tag(entry).sharpness == 0; });
}

}  // namespace

void ObjTags::read(std::string_view rest, std::size_t line) {
  const std::string_view kind = nextWord(rest);
  if (kind == "crease") {
    expectWord(rest, "2/1/0", line);
    const std::uint32_t a = readVertex(rest, line), b = readVertex(rest, line);
    creases_.push_back({{std::min(a, b), std::max(a, b), readSharpness(rest, line)}, line});
  } else if (kind == "corner") {
    expectWord(rest, "1/1/0", line);
    const std::uint32_t v = readVertex(rest, line);
    corners_.push_back({{v, readSharpness(rest, line)}, line});
  } else {
    fail(line, fmt::format("unknown tag '{}'; {}", kind, kAccepted));
  }
  const std::string_view extra = nextWord(rest);
  if (!extra.empty())
    fail(line, fmt::format("the tag goes on with '{}' after its sharpness; {}", extra, kAccepted));
}

void ObjTags::checkVertices(const TriangleMesh& mesh) const {
  const auto check = [&](std::uint32_t v, std::size_t line) {
    if (v >= mesh.positions.size())
      fail(line, fmt::format("the tag names vertex {}; the file's {} vertices count from 0 in tags",
                             v, mesh.positions.size()));
  };
  for (const Crease& c : creases_) {
    check(c.edge.v0, c.line);
    check(c.edge.v1, c.line);
  }
  for (const Corner& c : corners_) check(c.vertex.v, c.line);
}

void ObjTags::checkEdges(const TriangleMesh& mesh) const {
  std::unordered_set<std::uint64_t> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.insert(edgeKey(t[k], t[(k + 1) % 3]));
  for (const Crease& c : creases_)
    if (c.edge.v0 == c.edge.v1 || !edges.contains(edgeKey(c.edge.v0, c.edge.v1)))
      fail(c.line,
           fmt::format("crease {} - {} is not an edge of a face; vertices count from 0 in tags",
                       c.edge.v0, c.edge.v1));
}

void ObjTags::joinTo(TriangleMesh& mesh) {
  checkVertices(mesh);
  if (!creases_.empty()) checkEdges(mesh);
  settle(
      creases_, [](const Crease& c) { return c.edge; },
      [](const Crease& c) { return fmt::format("crease {} - {}", c.edge.v0, c.edge.v1); });
  settle(
      corners_, [](const Corner& c) { return c.vertex; },
      [](const Corner& c) { return fmt::format("corner {}", c.vertex.v); });
  for (const Crease& c : creases_) mesh.tags.edges.push_back(c.edge);
  for (const Corner& c : corners_) mesh.tags.vertices.push_back(c.vertex);
}

}  // namespace echocine
