#include "motion/keyframes/interpolation_judge.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "motion/mesh/surface_measure.h"

namespace echocine {

namespace {

// Weights of keyframes 0, 2, 4, ...; none if the kind rejects their spacing.
std::optional<KeyframeWeights> halfOf(const KeyframeWeights& all, Interpolation kind) {
  const std::span<const double> phases = all.phases();
  std::vector<double> kept;
  for (std::size_t k = 0; k < phases.size(); k += 2) kept.push_back(phases[k]);
  try {
    return KeyframeWeights(kept, kind, {}, all.pace());
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

// Vertices at a phase from keyframes 0, 2, 4, ... only.
std::vector<Vec3f> fromHalf(const ControlMotion& motion, const KeyframeWeights& half,
                            double phase) {
  std::vector<double> weights(half.keyframeCount());
  half.at(phase, weights);
  std::vector<Vec3d> sum(motion.rows_m.front().size());
  for (std::size_t k = 0; k < weights.size(); ++k)
    for (std::size_t v = 0; v < sum.size(); ++v)
      sum[v] = sum[v] + weights[k] * toDouble(motion.rows_m[2 * k][v]);
  std::vector<Vec3f> positions_m(sum.size());
  std::transform(sum.begin(), sum.end(), positions_m.begin(), toFloat);
  return positions_m;
}

// Adds one omitted keyframe; the sums are finally converted to root mean squares.
void addKeyframe(const ControlMotion& motion, const std::vector<Vec3f>& truth_m,
                 const std::vector<Vec3f>& found_m, InterpolationError& sums) {
  for (std::size_t v = 0; v < truth_m.size(); ++v) {
    const double distance_m = length(toDouble(found_m[v]) - toDouble(truth_m[v]));
    sums.vertex_rms_m += distance_m * distance_m;
    sums.vertex_max_m = std::max(sums.vertex_max_m, distance_m);
  }
  sums.vertices += truth_m.size();
  ++sums.left_out;
  if (motion.membrane) return;
  const double error_m3 =
      enclosedVolume(motion.triangles, found_m) - enclosedVolume(motion.triangles, truth_m);
  sums.volume_rms_m3 += error_m3 * error_m3;
  sums.volume_max_m3 = std::max(sums.volume_max_m3, std::abs(error_m3));
  ++sums.volumes;
}

void takeRoots(InterpolationError& e) {
  if (e.vertices > 0) e.vertex_rms_m = std::sqrt(e.vertex_rms_m / static_cast<double>(e.vertices));
  if (e.volumes > 0) e.volume_rms_m3 = std::sqrt(e.volume_rms_m3 / static_cast<double>(e.volumes));
}

}  // namespace

std::optional<InterpolationError> judgeInterpolation(const ControlMotion& motion,
                                                     Interpolation kind) {
  const std::span<const double> phases = motion.weights.phases();
  if (phases.size() < 4) return std::nullopt;
  const std::optional<KeyframeWeights> half = halfOf(motion.weights, kind);
  if (!half) return std::nullopt;
  InterpolationError e;
  e.kept = half->keyframeCount();
  for (std::size_t k = 1; k < phases.size(); k += 2)
    addKeyframe(motion, motion.rows_m[k], fromHalf(motion, *half, phases[k]), e);
  for (std::size_t k = 0; k < phases.size() && !motion.membrane; ++k)
    e.largest_volume_m3 =
        std::max(e.largest_volume_m3, enclosedVolume(motion.triangles, motion.rows_m[k]));
  if (e.largest_volume_m3 > 0) e.volume_max_share = e.volume_max_m3 / e.largest_volume_m3;
  takeRoots(e);
  return e;
}

InterpolationError pooled(std::span<const InterpolationError> errors) {
  InterpolationError all;
  for (const InterpolationError& e : errors) {
    all.kept += e.kept;
    all.left_out += e.left_out;
    all.vertices += e.vertices;
    all.volumes += e.volumes;
    all.vertex_rms_m += static_cast<double>(e.vertices) * e.vertex_rms_m * e.vertex_rms_m;
    all.volume_rms_m3 += static_cast<double>(e.volumes) * e.volume_rms_m3 * e.volume_rms_m3;
    all.vertex_max_m = std::max(all.vertex_max_m, e.vertex_max_m);
    all.volume_max_m3 = std::max(all.volume_max_m3, e.volume_max_m3);
    all.volume_max_share = std::max(all.volume_max_share, e.volume_max_share);
    all.largest_volume_m3 = std::max(all.largest_volume_m3, e.largest_volume_m3);
  }
  takeRoots(all);
  return all;
}

}  // namespace echocine
