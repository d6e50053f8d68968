#include "motion/heart/refined_part.h"

#include "motion/subdivision/shared_subdivision.h"

namespace echocine::heart {

RefinedPart::RefinedPart(const RecordedPart& part)
    : part_(part),
      subdivision_(sharedSubdivision(part.faces,
                                     static_cast<std::uint32_t>(part.control_m.front().size()),
                                     part.tags, Recording::kLevels, {})),
      points_m_(subdivision_->vertexCount()) {}

const std::vector<Triangle>& RefinedPart::triangles() const {
  return subdivision_->triangles();
}

const std::vector<Vec3f>& RefinedPart::pointsAt(std::size_t keyframe) {
  control_m_.clear();
  for (const Vec3d& p : part_.control_m[keyframe]) control_m_.push_back(toFloat(p));
  subdivision_->apply(control_m_, points_m_);
  return points_m_;
}

}  // namespace echocine::heart
