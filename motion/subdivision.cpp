#include "motion/subdivision.h"

#include <fmt/format.h>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <numeric>

#include "core/check.h"

namespace echocine {

namespace {

namespace far_ = OpenSubdiv::Far;
using OpenSubdiv::Sdc::Options;

constexpr std::size_t kMaxTriangles = 50'000'000;  // about 10 GB with their weights; our choice

// A control vertex in one vector register (an extension GCC and Clang share; left to itself the
// compiler adds the three coordinates one by one). The fourth lane is idle.
using PaddedPoint [[gnu::vector_size(16)]] = float;

void checkSize(std::size_t triangle_count, int levels, const SourcePlace& place) {
  std::size_t refined = triangle_count;
  for (int level = 0; level < levels && refined <= kMaxTriangles; ++level) refined *= 4;
  if (refined > kMaxTriangles)
    throw SceneError(atPlace(
        place,
        fmt::format("{} levels make more than {} triangles of this mesh's {}; use fewer levels",
                    levels, kMaxTriangles, triangle_count)));
}

std::unique_ptr<far_::TopologyRefiner> makeRefiner(std::span<const Triangle> triangles,
                                                   std::uint32_t vertex_count) {
  const std::vector<int> corner_counts(triangles.size(), 3);
  std::vector<int> corners;
  corners.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) corners.push_back(static_cast<int>(v));
  far_::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(vertex_count);
  descriptor.numFaces = static_cast<int>(triangles.size());
  descriptor.numVertsPerFace = corner_counts.data();
  descriptor.vertIndicesPerFace = corners.data();
  Options scheme;
  scheme.SetVtxBoundaryInterpolation(Options::VTX_BOUNDARY_EDGE_ONLY);
  using Factory = far_::TopologyRefinerFactory<far_::TopologyDescriptor>;
  return std::unique_ptr<far_::TopologyRefiner>(
      Factory::Create(descriptor, Factory::Options(OpenSubdiv::Sdc::SCHEME_LOOP, scheme)));
}

// The class templates, since the library's plain StencilTable casts down to what the object is not.
using Stencils = far_::StencilTableReal<float>;

std::unique_ptr<const Stencils> makeStencils(const far_::TopologyRefiner& refiner) {
  using Factory = far_::StencilTableFactoryReal<float>;
  Factory::Options options;
  options.generateIntermediateLevels = false;
  options.factorizeIntermediateLevels =
      true;  // weights of control vertices, not of the level before
  return std::unique_ptr<const Stencils>(Factory::Create(refiner, options));
}

std::vector<Triangle> lastLevelTriangles(const far_::TopologyRefiner& refiner) {
  const far_::TopologyLevel& level = refiner.GetLevel(refiner.GetMaxLevel());
  std::vector<Triangle> triangles;
  triangles.reserve(static_cast<std::size_t>(level.GetNumFaces()));
  for (int face = 0; face < level.GetNumFaces(); ++face) {
    const far_::ConstIndexArray v = level.GetFaceVertices(face);
    triangles.push_back({static_cast<std::uint32_t>(v[0]), static_cast<std::uint32_t>(v[1]),
                         static_cast<std::uint32_t>(v[2])});
  }
  return triangles;
}

}  // namespace

Subdivision::Subdivision(std::span<const Triangle> triangles, std::uint32_t vertex_count,
                         int levels, const SourcePlace& place)
    : control_count_(vertex_count) {
  CHECK_LE(1, levels);
  checkSize(triangles.size(), levels, place);
  // What goes wrong is reported here; the library would print.
  far_::SetErrorCallback([](far_::ErrorType, const char*) {});
  far_::SetWarningCallback([](const char*) {});
  const auto refiner = makeRefiner(triangles, vertex_count);
  if (!refiner)
    throw SceneError(atPlace(place, "the mesh cannot be subdivided; use subdivision = 0"));
  refiner->RefineUniform(far_::TopologyRefiner::UniformOptions(levels));
  triangles_ = lastLevelTriangles(*refiner);
  const auto stencils = makeStencils(*refiner);
  storeRows(stencils->GetSizes(), stencils->GetControlIndices(), stencils->GetWeights());
}

void Subdivision::storeRows(const std::vector<int>& sizes, const std::vector<int>& sources,
                            const std::vector<float>& weights) {
  std::vector<std::size_t> first(sizes.size() + 1, 0);
  for (std::size_t v = 0; v < sizes.size(); ++v)
    first[v + 1] = first[v] + static_cast<std::size_t>(sizes[v]);
  CHECK_LE(first.back(), sources.size());
  CHECK_LE(first.back(), weights.size());  // the table may hold more than its stencils use
  rows_.resize(sizes.size());
  std::iota(rows_.begin(), rows_.end(), 0u);
  std::stable_sort(rows_.begin(), rows_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return sizes[a] < sizes[b]; });
  weights_.reserve(first.back());
  sources_.reserve(first.back());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const std::uint32_t v = rows_[r];
    const auto length = static_cast<std::uint32_t>(sizes[v]);
    if (groups_.empty() || groups_.back().length != length) groups_.push_back({length, r, r});
    groups_.back().last_row = r + 1;
    for (std::size_t i = first[v]; i < first[v + 1]; ++i) {
      sources_.push_back(static_cast<std::uint32_t>(sources[i]));
      weights_.push_back(weights[i]);
    }
  }
}

void Subdivision::apply(std::span<const Vec3f> control, std::span<Vec3f> refined) const {
  CHECK_EQ(control.size(), control_count_);
  CHECK_EQ(refined.size(), rows_.size());
  thread_local std::vector<PaddedPoint> padded;
  padded.clear();
  for (const Vec3f& p : control) padded.push_back(PaddedPoint{p.x, p.y, p.z, 0});
  const PaddedPoint* const points = padded.data();
  const std::uint32_t* source = sources_.data();
  const float* weight = weights_.data();
  for (const Group& group : groups_) {
    for (std::size_t r = group.first_row; r < group.last_row; ++r) {
      PaddedPoint sum{};
      for (std::uint32_t i = 0; i < group.length; ++i) sum += *weight++ * points[*source++];
      refined[rows_[r]] = {sum[0], sum[1], sum[2]};
    }
  }
}

}  // namespace echocine
