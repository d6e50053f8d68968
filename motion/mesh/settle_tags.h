#pragma once
// Brings creases or corners from several sources into the order of MeshTags.

#include <algorithm>
#include <cstddef>
#include <vector>

#include "scene/mesh_tags.h"

namespace echocine {

inline std::uint64_t tagKey(const SharpEdge& edge) {
  return edgeKey(edge.v0, edge.v1);
}
inline std::uint64_t tagKey(const SharpVertex& vertex) {
  return vertex.v;
}

// Ascending by key, each once. `tag` returns the SharpEdge or SharpVertex of a Named. `refuse`,
// which must throw, is called with two of equal key and different sharpness, in their original
// order.
template <typename Named, typename Tag, typename Refuse>
void settleTags(std::vector<Named>& named, const Tag& tag, const Refuse& refuse) {
  const auto sameKey = [&](const Named& a, const Named& b) {
    return tagKey(tag(a)) == tagKey(tag(b));
  };
  std::stable_sort(named.begin(), named.end(),
                   [&](const Named& a, const Named& b) { return tagKey(tag(a)) < tagKey(tag(b)); });
  for (std::size_t i = 1; i < named.size(); ++i)
    if (sameKey(named[i - 1], named[i]) && tag(named[i - 1]).sharpness != tag(named[i]).sharpness)
      refuse(named[i - 1], named[i]);
  named.erase(std::unique(named.begin(), named.end(), sameKey), named.end());
}

}  // namespace echocine
