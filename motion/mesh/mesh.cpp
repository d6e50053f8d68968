#include "motion/mesh/mesh.h"

#include <numeric>

namespace echocine {

void appendFan(std::span<const std::uint32_t> corners, std::size_t face, TriangleMesh& mesh) {
  // Indices are recorded from the first polygon on.
  const bool numbered = !mesh.faces.empty() || corners.size() > 3;
  if (numbered && mesh.faces.empty()) {
    mesh.faces.resize(mesh.triangles.size());
    std::iota(mesh.faces.begin(), mesh.faces.end(), 0u);
  }
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    if (numbered) mesh.faces.push_back(static_cast<std::uint32_t>(face));
  }
}

}  // namespace echocine
