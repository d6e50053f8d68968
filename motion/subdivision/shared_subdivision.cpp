#include "motion/subdivision/shared_subdivision.h"

#include <algorithm>
#include <list>
#include <mutex>

namespace echocine {

namespace {

// Parametric hearts have fewer topologies, and at most 32,000 triangles in one, a shell of the
// chest wall; larger meshes of users are not cached. Our choice.
constexpr std::size_t kMostKept = 24, kLargestKept = 40000;  // triangles after subdivision

template <typename Made>
struct Kept {
  std::vector<Triangle> triangles;
  std::uint32_t vertex_count;
  int levels;
  MeshTags tags;
  std::shared_ptr<const Made> made;

  bool isOf(std::span<const Triangle> of, std::uint32_t vertices, const MeshTags& its_tags,
            int its_levels) const {
    return vertex_count == vertices && levels == its_levels && tags == its_tags &&
           std::equal(triangles.begin(), triangles.end(), of.begin(), of.end());
  }
};

template <typename Made>
struct Keep {
  std::mutex mutex;
  std::list<Kept<Made>> kept;  // most recently used first
};

template <typename Made>
std::shared_ptr<const Made> shared(std::span<const Triangle> triangles, std::uint32_t vertex_count,
                                   const MeshTags& tags, int levels, const SourcePlace& place) {
  static Keep<Made> all;
  {
    const std::lock_guard lock(all.mutex);
    const auto found = std::find_if(all.kept.begin(), all.kept.end(), [&](const Kept<Made>& kept) {
      return kept.isOf(triangles, vertex_count, tags, levels);
    });
    if (found != all.kept.end()) {
      all.kept.splice(all.kept.begin(), all.kept, found);
      return found->made;
    }
  }
  // Computed outside the lock: at worst two threads compute the same.
  auto made = std::make_shared<const Made>(triangles, vertex_count, tags, levels, place);
  if (triangles.size() << (2 * levels) > kLargestKept) return made;
  const std::lock_guard lock(all.mutex);
  all.kept.push_front({{triangles.begin(), triangles.end()}, vertex_count, levels, tags, made});
  if (all.kept.size() > kMostKept) all.kept.pop_back();
  return made;
}

}  // namespace

std::shared_ptr<const Subdivision> sharedSubdivision(std::span<const Triangle> triangles,
                                                     std::uint32_t vertex_count,
                                                     const MeshTags& tags, int levels,
                                                     const SourcePlace& place) {
  return shared<Subdivision>(triangles, vertex_count, tags, levels, place);
}

std::shared_ptr<const LimitNormals> sharedLimitNormals(std::span<const Triangle> triangles,
                                                       std::uint32_t vertex_count,
                                                       const MeshTags& tags, int levels,
                                                       const SourcePlace& place) {
  return shared<LimitNormals>(triangles, vertex_count, tags, levels, place);
}

}  // namespace echocine
