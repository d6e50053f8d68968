#pragma once
// A recorded part's surface after Recording::kLevels of Loop subdivision.

#include <memory>
#include <vector>

#include "motion/heart/recording.h"

namespace echocine {
class Subdivision;
}

namespace echocine::heart {

class RefinedPart {
 public:
  explicit RefinedPart(const RecordedPart& part);  // must outlive this

  const std::vector<Triangle>& triangles() const;
  // First the control vertices, moved by the subdivision. Valid until the next call.
  const std::vector<Vec3f>& pointsAt(std::size_t keyframe);

 private:
  const RecordedPart& part_;
  std::shared_ptr<const Subdivision> subdivision_;
  std::vector<Vec3f> control_m_, points_m_;
};

}  // namespace echocine::heart
