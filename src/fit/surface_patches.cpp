#include "fit/surface_patches.h"

#include <algorithm>
#include <utility>

#include "core/box.h"

namespace echocine::fit {

namespace {

// Halves a list across its longest side until each part is a patch.
void halve(std::span<const Vec3f> places_m, std::span<std::uint32_t> vertices) {
  if (vertices.size() <= kPatch) return;
  Box box;
  for (const std::uint32_t v : vertices) box.add(toDouble(places_m[v]));
  const Vec3d side_m = box.hi - box.lo;
  const float Vec3f::*along = side_m.x >= std::max(side_m.y, side_m.z) ? &Vec3f::x
                              : side_m.y >= side_m.z                   ? &Vec3f::y
                                                                       : &Vec3f::z;
  const std::size_t half = (vertices.size() / 2 + kPatch - 1) / kPatch * kPatch;
  std::nth_element(vertices.begin(), vertices.begin() + static_cast<std::ptrdiff_t>(half),
                   vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair{places_m[a].*along, a} < std::pair{places_m[b].*along, b};
                   });
  halve(places_m, vertices.first(half));
  halve(places_m, vertices.subspan(half));
}

}  // namespace

void orderByPlace(std::span<const Vec3f> places_m, std::vector<std::uint32_t>& vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  halve(places_m, vertices);
}

SurfacePatches patchesOf(std::span<SurfaceTopology> surfaces) {
  std::vector<SurfacePatch> patches;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    std::vector<Triangle>& triangles = surfaces[s].triangles;
    std::stable_sort(triangles.begin(), triangles.end(), [](const Triangle& a, const Triangle& b) {
      return a[0] / kPatch < b[0] / kPatch;
    });
    const std::size_t first_patch = patches.size();
    for (std::uint32_t v = 0; v < surfaces[s].vertex_count; v += kPatch)
      patches.push_back({s, v, std::min(v + kPatch, surfaces[s].vertex_count), {}, {}});
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      TriangleRange& own = patches[first_patch + triangles[t][0] / kPatch].triangles;
      own = {own.end == 0 ? t : own.first, t + 1};
      for (const std::uint32_t v : triangles[t]) {
        std::vector<std::uint32_t>& touched = patches[first_patch + v / kPatch].touched;
        touched.insert(touched.end(), triangles[t].begin(), triangles[t].end());
      }
    }
  }
  for (SurfacePatch& patch : patches) {
    std::sort(patch.touched.begin(), patch.touched.end());
    patch.touched.erase(std::unique(patch.touched.begin(), patch.touched.end()),
                        patch.touched.end());
  }
  return std::make_shared<const std::vector<SurfacePatch>>(std::move(patches));
}

}  // namespace echocine::fit
