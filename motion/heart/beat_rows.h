#pragma once
// One surface at all keyframes of a beat, arranged for parallel lanes over the keyframes.

#include <vector>

#include "core/lanes.h"
#include "core/vec3.h"

namespace echocine::heart {

// A row has one coordinate of one vertex at all keyframes in order. The last keyframe comes before
// the first, and the first ones follow the last, so four successive intervals with their neighbours
// are plain loads.
class BeatRows {
 public:
  // One entry per keyframe, all with as many vertices. Precondition: at least one keyframe.
  explicit BeatRows(const std::vector<std::vector<Vec3d>>& keyframes)
      : keyframes_(keyframes.size()),
        stride_((keyframes_ + 2 * kDoubleLanes - 1) / kDoubleLanes * kDoubleLanes),
        values_(3 * stride_ * keyframes.front().size()) {
    double* to = values_.data();
    for (std::size_t v = 0; v < keyframes.front().size(); ++v)
      for (double Vec3d::*axis : {&Vec3d::x, &Vec3d::y, &Vec3d::z})
        for (std::size_t i = 0; i < stride_; ++i)
          *to++ = keyframes[(i + keyframes_ - 1) % keyframes_][v].*axis;
  }

  std::size_t keyframes() const { return keyframes_; }
  std::size_t vertexSize() const { return 3 * stride_; }  // numbers per vertex, a multiple of four
  double* vertex(std::size_t v) { return &values_[v * vertexSize()]; }
  const double* vertex(std::size_t v) const { return &values_[v * vertexSize()]; }

  Vec3d at(std::size_t v, std::size_t keyframe) const {
    const double* const x = vertex(v) + keyframe + 1;
    return {x[0], x[stride_], x[2 * stride_]};
  }
  // An axis of a vertex from the keyframe before `keyframe` on.
  const double* before(std::size_t v, std::size_t axis, std::size_t keyframe) const {
    return vertex(v) + axis * stride_ + keyframe;
  }

 private:
  std::size_t keyframes_, stride_;
  std::vector<double> values_;
};

}  // namespace echocine::heart
