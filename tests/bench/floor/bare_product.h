#pragma once
// The floor of subdivision: OpenSubdiv's stencils as a plain CSR matrix and the shortest loops over
// it. A measure: no checks, no order of rows.

#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <memory>
#include <vector>

#include "motion/surfaces/surface_frame.h"
#include "support/meshes.h"

namespace echocine::bench {

class BareProduct {
 public:
  BareProduct(const support::Mesh& mesh, int levels) {
    namespace far_ = OpenSubdiv::Far;
    std::vector<int> counts(mesh.triangles.size(), 3), corners;
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) corners.push_back(static_cast<int>(v));
    far_::TopologyDescriptor descriptor;
    descriptor.numVertices = static_cast<int>(mesh.points.size());
    descriptor.numFaces = static_cast<int>(mesh.triangles.size());
    descriptor.numVertsPerFace = counts.data();
    descriptor.vertIndicesPerFace = corners.data();
    using Refiners = far_::TopologyRefinerFactory<far_::TopologyDescriptor>;
    const std::unique_ptr<far_::TopologyRefiner> refiner(
        Refiners::Create(descriptor, Refiners::Options(OpenSubdiv::Sdc::SCHEME_LOOP)));
    refiner->RefineUniform(far_::TopologyRefiner::UniformOptions(levels));
    using Tables = far_::StencilTableFactoryReal<float>;
    Tables::Options options;
    options.generateIntermediateLevels = false;
    const std::unique_ptr<const far_::StencilTableReal<float>> table(
        Tables::Create(*refiner, options));
    begin_.push_back(0);
    for (const int size : table->GetSizes()) begin_.push_back(begin_.back() + size);
    columns_.assign(table->GetControlIndices().begin(),
                    table->GetControlIndices().begin() + begin_.back());
    weights_.assign(table->GetWeights().begin(), table->GetWeights().begin() + begin_.back());
  }

  std::size_t rows() const { return begin_.size() - 1; }
  std::size_t weights() const { return weights_.size(); }

  // Three coordinates in three sums.
  void scalar(const std::vector<Vec3f>& control, std::vector<Vec3f>& out) const {
    for (std::size_t r = 0; r < rows(); ++r) {
      float x = 0, y = 0, z = 0;
      for (int i = begin_[r]; i < begin_[r + 1]; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Vec3f& p = control[static_cast<std::size_t>(columns_[k])];
        x += weights_[k] * p.x;
        y += weights_[k] * p.y;
        z += weights_[k] * p.z;
      }
      out[r] = {x, y, z};
    }
  }

  // A point per register; filling the registers counts.
  void vectorised(const std::vector<Vec3f>& control, std::vector<Vec3f>& out) {
    points_.clear();
    for (const Vec3f& p : control) points_.push_back(Four{p.x, p.y, p.z, 0});
    for (std::size_t r = 0; r < rows(); ++r) {
      Four sum{};
      for (int i = begin_[r]; i < begin_[r + 1]; ++i) {
        const auto k = static_cast<std::size_t>(i);
        sum += weights_[k] * points_[static_cast<std::size_t>(columns_[k])];
      }
      out[r] = {sum[0], sum[1], sum[2]};
    }
  }

 private:
  using Four [[gnu::vector_size(16)]] = float;
  std::vector<int> begin_, columns_;
  std::vector<float> weights_;
  std::vector<Four> points_;
};

}  // namespace echocine::bench
