#include "motion/keyframes/control_motion.h"

#include <algorithm>

#include "motion/mesh/mesh_check.h"

namespace echocine {

namespace {

// target = sum of weight * source in the order of the terms, four at most in one pass over memory.
// Plain arrays of floats, so that the compiler vectorises across coordinates.
template <std::size_t kTerms>
void blend(const float* const* from, const float* weight, std::size_t count, float* to) {
  for (std::size_t i = 0; i < count; ++i) {
    float sum = weight[0] * from[0][i];
    for (std::size_t k = 1; k < kTerms; ++k) sum += weight[k] * from[k][i];
    to[i] = sum;
  }
}

void add(float weight, const float* from, std::size_t count, float* to) {
  for (std::size_t i = 0; i < count; ++i) to[i] += weight * from[i];
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
  const std::size_t count = 3 * positions_m.size();
  float* const to = &positions_m.data()->x;
  const float* from[4];
  float weight[4];
  for (std::size_t k = 0; k < std::min<std::size_t>(terms.size(), 4); ++k) {
    from[k] = &rows_m[terms[k].row].data()->x;
    weight[k] = static_cast<float>(terms[k].weight);
  }
  if (terms.size() == 2) return blend<2>(from, weight, count, to);
  if (terms.size() == 3) return blend<3>(from, weight, count, to);
  blend<4>(from, weight, count, to);
  for (std::size_t k = 4; k < terms.size(); ++k)  // the trigonometric polynomial uses all keyframes
    add(static_cast<float>(terms[k].weight), &rows_m[terms[k].row].data()->x, count, to);
}

std::string ControlMotion::fileOf(std::size_t keyframe) const {
  return parts[keyframe].front().file.string();
}

std::string ControlMotion::faceName(std::size_t keyframe, std::size_t triangle) const {
  return echocine::faceName(parts[keyframe], triangle);
}

}  // namespace echocine
