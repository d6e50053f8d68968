#include "motion/mesh/tag_join.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>

#include "core/error.h"
#include "motion/mesh/settle_tags.h"

namespace echocine {

namespace {

// Appends `added` to `tags` and resolves duplicates.
template <typename Tag>
void merge(std::vector<Tag>& tags, const std::vector<Tag>& added,
           const std::filesystem::path& file) {
  tags.insert(tags.end(), added.begin(), added.end());
  settleTags(tags, std::identity{}, [&](const Tag& first, const Tag& second) {
    throw SceneError(fmt::format(
        "{}: a crease or corner has sharpness {:g} and {:g} where the lid is joined; one "
        "sharpness is accepted",
        file.string(), first.sharpness, second.sharpness));
  });
}

}  // namespace

void joinTags(const MeshTags& lid, std::span<const std::uint32_t> joined_from_lid,
              const std::filesystem::path& file, MeshTags& tags) {
  MeshTags moved;
  for (const SharpEdge& e : lid.edges) {
    const std::uint32_t a = joined_from_lid[e.v0], b = joined_from_lid[e.v1];
    moved.edges.push_back({std::min(a, b), std::max(a, b), e.sharpness});
  }
  for (const SharpVertex& c : lid.vertices)
    moved.vertices.push_back({joined_from_lid[c.v], c.sharpness});
  merge(tags.edges, moved.edges, file);
  merge(tags.vertices, moved.vertices, file);
}

}  // namespace echocine
