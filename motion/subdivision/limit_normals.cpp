#include "motion/subdivision/limit_normals.h"

#include <fmt/format.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>

#include "core/check.h"
#include "motion/subdivision/limit_places.h"
#include "motion/subdivision/refiner.h"

namespace echocine {

namespace {

namespace far_ = OpenSubdiv::Far;

// The library's own limit of isolation.
constexpr int kMaxIsolation = 10;

// Tangents of the limit surface at each place. The library's patches have the limit's tangents at
// their corners. Isolated at least to the level of the refined mesh, each of its vertices is a
// corner. Semi-sharp creases are followed until they are smooth.
using LimitStencils = far_::LimitStencilTableReal<float>;

int isolationLevel(const MeshTags& tags, int levels) {
  float sharpest = 0;
  for (const SharpEdge& e : tags.edges)
    if (e.sharpness < kInfiniteSharpness) sharpest = std::max(sharpest, e.sharpness);
  for (const SharpVertex& c : tags.vertices)
    if (c.sharpness < kInfiniteSharpness) sharpest = std::max(sharpest, c.sharpness);
  return std::clamp(std::max(levels, static_cast<int>(std::ceil(sharpest))), 1, kMaxIsolation);
}

// Limits of the library's set-up. Measured: a vertex of 100 faces takes 2 s, one of 200 takes 20 s;
// a fractional crease takes 16 kB for each piece into which it is split. Our choices.
constexpr std::uint32_t kMaxFacesAtVertex = 128;
constexpr double kMaxCreasePieces = 200e3;

void checkSetUp(std::span<const Triangle> triangles, std::uint32_t vertex_count,
                const MeshTags& tags, int isolation, const SourcePlace& place) {
  std::vector<std::uint32_t> faces_at(vertex_count, 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) ++faces_at[v];
  const std::uint32_t most = *std::max_element(faces_at.begin(), faces_at.end());
  if (most > kMaxFacesAtVertex)
    throw SceneError(atPlace(
        place, fmt::format("smooth normals accept up to {} faces at a vertex, this mesh has one "
                           "with {}; split it or use normals = \"facet\"",
                           kMaxFacesAtVertex, most)));
  const auto fractional =
      std::count_if(tags.edges.begin(), tags.edges.end(),
                    [](const SharpEdge& e) { return e.sharpness < kInfiniteSharpness; });
  if (std::ldexp(static_cast<double>(fractional), isolation) > kMaxCreasePieces)
    throw SceneError(atPlace(
        place, fmt::format("smooth normals need {} levels to follow this mesh's {} creases that "
                           "are not infinitely sharp; make them 10 or softer",
                           isolation, fractional)));
}

std::unique_ptr<const LimitStencils> makeLimitStencils(far_::TopologyRefiner& refiner,
                                                       const LimitPlaces& places, int isolation) {
  far_::PatchTableFactory::Options patches(static_cast<unsigned>(isolation));
  patches.SetEndCapType(far_::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
  patches.useInfSharpPatch = true;
  patches.generateLegacySharpCornerPatches = false;
  refiner.RefineAdaptive(patches.GetRefineAdaptiveOptions());
  const std::unique_ptr<const far_::PatchTable> table(
      far_::PatchTableFactory::Create(refiner, patches));
  using Factory = far_::LimitStencilTableFactoryReal<float>;
  std::vector<float> u, v;
  for (const auto& on_face : places.on_face)
    for (const LimitPlaces::Place& place : on_face) {
      u.push_back(place.u);
      v.push_back(place.v);
    }
  Factory::LocationArrayVec locations;
  std::size_t first = 0;
  for (std::size_t face = 0; face < places.on_face.size(); ++face) {
    const std::size_t count = places.on_face[face].size();
    if (count == 0) continue;
    Factory::LocationArray array;
    array.ptexIdx = static_cast<int>(face);  // of a triangle: its own number
    array.numLocations = static_cast<int>(count);
    array.s = &u[first];
    array.t = &v[first];
    locations.push_back(array);
    first += count;
  }
  return std::unique_ptr<const LimitStencils>(
      Factory::Create(refiner, locations, nullptr, table.get()));
}

PaddedPoint cross(PaddedPoint a, PaddedPoint b) {
  const PaddedPoint a_yzx = __builtin_shufflevector(a, a, 1, 2, 0, 3),
                    b_yzx = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const PaddedPoint zxy = a * b_yzx - a_yzx * b;
  return __builtin_shufflevector(zxy, zxy, 1, 2, 0, 3);
}

float squared(PaddedPoint a) {
  const PaddedPoint s = a * a;
  return s[0] + s[1] + s[2];
}

// If the tangents are parallel except for rounding, there is no normal: for example at the corner
// of a sheet's single face, whose boundary curve is smooth.
Vec3f unitNormal(PaddedPoint du, PaddedPoint dv) {
  constexpr float kParallel = 1e-4f;  // sine of the angle between them
  const PaddedPoint n = cross(du, dv);
  const float size2 = squared(n);
  if (!(size2 > kParallel * kParallel * squared(du) * squared(dv))) return {};
  const PaddedPoint unit = n / std::sqrt(size2);
  return {unit[0], unit[1], unit[2]};
}

// The entries of all stencils, without those that are zero within rounding: a place at a corner
// uses 7 of its patch's 12 points.
struct Entries {
  std::vector<int> sizes, sources;
  std::vector<float> du, dv;

  explicit Entries(const LimitStencils& stencils) {
    std::size_t first = 0;
    for (const int size : stencils.GetSizes()) {
      add(stencils, first, first + static_cast<std::size_t>(size));
      first += static_cast<std::size_t>(size);
    }
  }

 private:
  void add(const LimitStencils& stencils, std::size_t begin, std::size_t end) {
    constexpr float kNothing = 1e-6f;  // of the largest weight
    const auto size = [&](std::size_t i) {
      return std::max(std::abs(stencils.GetDuWeights()[i]), std::abs(stencils.GetDvWeights()[i]));
    };
    float largest = 0;
    for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, size(i));
    const std::size_t before = sources.size();
    for (std::size_t i = begin; i < end; ++i) {
      if (!(size(i) > kNothing * largest)) continue;
      sources.push_back(stencils.GetControlIndices()[i]);
      du.push_back(stencils.GetDuWeights()[i]);
      dv.push_back(stencils.GetDvWeights()[i]);
    }
    sizes.push_back(static_cast<int>(sources.size() - before));
  }
};

}  // namespace

LimitNormals::LimitNormals(std::span<const Triangle> triangles, std::uint32_t vertex_count,
                           const MeshTags& tags, int levels, const SourcePlace& place)
    : control_count_(vertex_count) {
  checkRefinedSize(triangles, vertex_count, levels, 2, place);
  checkSetUp(triangles, vertex_count, tags, isolationLevel(tags, levels), place);
  const auto refiner = makeRefiner(triangles, vertex_count, tags, place);
  if (levels > 0) {
    far_::TopologyRefiner::UniformOptions uniform(levels);
    uniform.fullTopologyInLastLevel = true;  // its edges' sharpness is requested
    refiner->RefineUniform(uniform);
  }
  LimitPlaces places = limitPlaces(*refiner);
  normal_count_ = places.normal_count;
  if (places.split) corners_ = std::move(places.corners);
  refiner->Unrefine();
  const auto stencils = makeLimitStencils(*refiner, places, isolationLevel(tags, levels));
  if (!stencils)
    throw SceneError(atPlace(place, "the mesh has no limit surface; use normals = \"facet\""));
  const Entries entries(*stencils);
  rows_ = StencilRows(entries.sizes, entries.sources);
  const std::vector<float> du = rows_.arranged(entries.sizes, entries.du);
  const std::vector<float> dv = rows_.arranged(entries.sizes, entries.dv);
  for (std::size_t i = 0; i < du.size(); ++i) weights_.push_back({du[i], dv[i]});
  std::vector<std::uint32_t> normals;
  for (const auto& on_face : places.on_face)
    for (const LimitPlaces::Place& p : on_face) normals.push_back(p.normal);
  CHECK_EQ(normals.size(), rows_.rows().size());
  for (const std::uint32_t row : rows_.rows()) normal_of_stencil_.push_back(normals[row]);
}

// A tangent's weights sum to zero, so sources are taken relative to the row's first one: far from
// the probe the sum of large coordinates would leave their rounding. A plane thus stays exactly
// flat.
void LimitNormals::apply(std::span<const Vec3f> control, std::span<Vec3f> normals) const {
  CHECK_EQ(control.size(), control_count_);
  CHECK_EQ(normals.size(), normal_count_);
  const PaddedPoint* const points = padded(control);
  const std::uint32_t* source = rows_.sources().data();
  const Tangents* weight = weights_.data();
  for (const StencilRows::Group& group : rows_.groups()) {
    for (std::size_t r = group.first_row; r < group.last_row && group.length > 0; ++r) {
      const PaddedPoint first = points[*source];
      PaddedPoint du{}, dv{};
      for (std::uint32_t i = 0; i < group.length; ++i, ++weight) {
        const PaddedPoint from_first = points[*source++] - first;
        du += weight->du * from_first;
        dv += weight->dv * from_first;
      }
      normals[normal_of_stencil_[r]] = unitNormal(du, dv);
    }
  }
}

}  // namespace echocine
