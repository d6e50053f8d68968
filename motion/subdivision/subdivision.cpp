#include "motion/subdivision/subdivision.h"

#include <opensubdiv/far/stencilTableFactory.h>

#include <cstddef>
#include <memory>

#include "core/check.h"
#include "motion/subdivision/refiner.h"

namespace echocine {

namespace {

namespace far_ = OpenSubdiv::Far;

// Points of boundary curves, sharp creases and corners are sums of at most this many points of the
// curve, the four of cubic B-spline subdivision. Their weights have few binary digits, so the sums
// are exact in double precision, in any order: meshes that share a curve share the refined one to
// the last bit.
constexpr std::uint32_t kCurvePoints = 4;
using WidePoint [[gnu::vector_size(32)]] = double;

// The class templates, because the library's plain StencilTable casts down to a type that the
// object does not have.
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
                         const MeshTags& tags, int levels, const SourcePlace& place)
    : control_count_(vertex_count) {
  CHECK_LE(1, levels);
  checkRefinedSize(triangles, vertex_count, levels, 1, place);
  const auto refiner = makeRefiner(triangles, vertex_count, tags, place);
  refiner->RefineUniform(far_::TopologyRefiner::UniformOptions(levels));
  triangles_ = lastLevelTriangles(*refiner);
  const auto stencils = makeStencils(*refiner);
  rows_ = StencilRows(stencils->GetSizes(), stencils->GetControlIndices());
  weights_ = rows_.arranged(stencils->GetSizes(), stencils->GetWeights());
}

void Subdivision::apply(std::span<const Vec3f> control, std::span<Vec3f> refined) const {
  CHECK_EQ(control.size(), control_count_);
  CHECK_EQ(refined.size(), rows_.rows().size());
  const PaddedPoint* const points = padded(control);
  const std::uint32_t* source = rows_.sources().data();
  const std::uint32_t* row = rows_.rows().data();
  const float* weight = weights_.data();
  for (const StencilRows::Group& group : rows_.groups()) {
    if (group.length <= kCurvePoints) {
      for (std::size_t r = group.first_row; r < group.last_row; ++r) {
        WidePoint sum{};
        for (std::uint32_t i = 0; i < group.length; ++i)
          sum += double{*weight++} * __builtin_convertvector(points[*source++], WidePoint);
        refined[row[r]] = toFloat({sum[0], sum[1], sum[2]});
      }
      continue;
    }
    for (std::size_t r = group.first_row; r < group.last_row; ++r) {
      PaddedPoint sum{};
      for (std::uint32_t i = 0; i < group.length; ++i) sum += *weight++ * points[*source++];
      refined[row[r]] = {sum[0], sum[1], sum[2]};
    }
  }
}

}  // namespace echocine
