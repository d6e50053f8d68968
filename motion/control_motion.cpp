#include "motion/control_motion.h"

#include "motion/mesh_check.h"

namespace echocine {

namespace {

// target = weight * source, or target += weight * source. Plain arrays of floats, so that the
// compiler vectorises across coordinates.
void blend(float weight, const std::vector<Vec3f>& source, bool is_first,
           std::vector<Vec3f>& target) {
  const float* const from = &source.data()->x;
  float* const to = &target.data()->x;
  const std::size_t count = 3 * source.size();
  if (is_first) {
    for (std::size_t i = 0; i < count; ++i) to[i] = weight * from[i];
  } else {
    for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
  }
}

}  // namespace

void ControlMotion::at(double phase, std::vector<Vec3f>& positions_m) const {
  thread_local std::vector<KeyframeWeights::Term> terms;
  weights.termsAt(phase, terms);
  if (terms.size() == 1) {  // a keyframe, or a still structure: exactly as read
    positions_m = rows_m[terms[0].row];
    return;
  }
  positions_m.resize(rows_m.front().size());
  for (std::size_t i = 0; i < terms.size(); ++i)
    blend(static_cast<float>(terms[i].weight), rows_m[terms[i].row], i == 0, positions_m);
}

std::string ControlMotion::fileOf(std::size_t keyframe) const {
  return parts[keyframe].front().file.string();
}

std::string ControlMotion::faceName(std::size_t keyframe, std::size_t triangle) const {
  return echocine::faceName(parts[keyframe], triangle);
}

}  // namespace echocine
