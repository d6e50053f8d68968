#include "motion/heart/recording.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"
#include "motion/heart/fold_repair.h"
#include "motion/heart/leaflet.h"
#include "motion/heart/refined_part.h"
#include "motion/heart/surroundings.h"
#include "motion/mesh/surface_measure.h"

namespace echocine::heart {
namespace {

// Rate of change at a phase, per beat: filling, and leaflets, weighted like half a stroke volume;
// plus a small constant. Our choice.
double activity(const Cycle& cycle, double phase) {
  constexpr double kStep = 1e-3, kLeaflets = 0.5, kAlways = 1.2;
  const State a = cycle.at(phase), b = cycle.at(std::min(phase + kStep, 1 - 1e-9));
  const double leaflets = std::max({std::abs(b.mitral - a.mitral), std::abs(b.aortic - a.aortic),
                                    std::abs(b.tricuspid - a.tricuspid)});
  return kAlways + (std::abs(b.left.ejected - a.left.ejected) + kLeaflets * leaflets) / kStep;
}

LoopFit fitOf(const Part& part, const MeshTags& tags) {
  std::vector<std::uint32_t> corners;
  for (const SharpVertex& corner : tags.vertices) corners.push_back(corner.v);
  return {part.points.size(), part.faces, corners};
}

// One entry per instant.
std::vector<std::vector<Vec3d>> controlPoints(const LoopFit& fit,
                                              std::span<const std::vector<Vec3d>> instants) {
  std::vector<std::vector<Vec3d>> control = fit.controlPoints(instants);
  for (std::vector<Vec3d>& points : control)
    std::transform(points.begin(), points.end(), points.begin(), toMicrometre);
  return control;
}

std::size_t nearest(const std::vector<double>& phases, double phase) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < phases.size(); ++k)
    if (std::abs(phases[k] - phase) < std::abs(phases[best] - phase)) best = k;
  return best;
}

std::vector<double> evenPhases(int count) {
  std::vector<double> phases;
  for (int k = 0; k < count; ++k) phases.push_back(std::round(1e6 * k / count) * 1e-6);
  return phases;
}

MeshTags tagsOf(const Part& part) {
  MeshTags tags;
  if (!part.kind.membrane) return tags;
  for (const std::uint32_t corner : sheetCorners(kLeafletRows, kLeafletColumns))
    tags.vertices.push_back({corner, kInfiniteSharpness});
  return tags;
}

void measureVolumes(RecordedPart& part) {
  if (part.kind.membrane) return;
  RefinedPart refined(part);
  for (std::size_t k = 0; k < part.control_m.size(); ++k)
    part.volume_m3.push_back(enclosedVolume(refined.triangles(), refined.pointsAt(k)));
}

void measureVolumes(Recording& recording) {
  parallelBlocks(recording.parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) measureVolumes(recording.parts[p]);
  });
}

// The heart at all phases.
std::vector<Shape> shapesAt(const ParametricHeart& heart, const std::vector<double>& phases,
                            const Monitor& monitor) {
  std::vector<Shape> shapes(phases.size());
  parallelBlocks(phases.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (!monitor.keep_going()) throw JobError("stopped");
      shapes[k] = heart.shapeAt(phases[k]);
    }
  });
  return shapes;
}

std::vector<double> reachOfSac(const ParametricHeart& heart, std::span<const Shape* const> shapes) {
  std::vector<double> reach_m;
  for (const Shape* shape : shapes)
    for (const Part& part : shape->parts) {
      if (part.kind.name != "pericardium") continue;
      reach_m.resize(part.points.size(), 0);
      for (std::size_t i = 0; i < reach_m.size(); ++i)
        reach_m[i] = std::max(reach_m[i], length(part.points[i] - heart.centre()));
    }
  return reach_m;
}

}  // namespace

const RecordedPart& Recording::part(std::string_view name) const {
  const auto found = std::find_if(parts.begin(), parts.end(), [name](const RecordedPart& part) {
    return part.kind.name == name;
  });
  CHECK_EQ(found != parts.end(), true);
  return *found;
}

std::vector<double> keyframePhases(const Cycle& cycle, int count) {
  CHECK_LE(4, count);
  constexpr int kSteps = 2000;
  std::vector<double> sum(kSteps + 1, 0);
  for (int i = 0; i < kSteps; ++i) sum[i + 1] = sum[i] + activity(cycle, (i + 0.5) / kSteps);
  std::vector<double> phases;
  std::size_t i = 0;
  for (int k = 0; k < count; ++k) {
    const double want = sum.back() * k / count;
    while (sum[i + 1] < want) ++i;
    phases.push_back((static_cast<double>(i) + (want - sum[i]) / (sum[i + 1] - sum[i])) / kSteps);
  }
  // The nearest keyframe is moved to end-systole.
  const double end_systole = cycle.events().aortic_closes;
  phases[nearest(phases, end_systole)] = end_systole;
  for (double& phase : phases) phase = std::round(phase * 1e6) * 1e-6;  // as files hold them
  return phases;
}

Recording recordBeat(const ParametricHeart& heart, View view, int keyframes,
                     KeyframeSpacing spacing, const Monitor& monitor) {
  Recording recording;
  recording.phases = spacing == KeyframeSpacing::even ? evenPhases(keyframes)
                                                      : keyframePhases(heart.cycle(), keyframes);
  recording.end_systole_phase = heart.cycle().events().aortic_closes;
  recording.end_systole = nearest(recording.phases, recording.end_systole_phase);

  std::vector<double> phases = recording.phases;  // the first is 0
  phases.push_back(recording.end_systole_phase);  // to its last digit, for the sac
  std::vector<Shape> shapes = shapesAt(heart, phases, monitor);
  const std::array sacs{&shapes.front(), &shapes.back()};
  recording.sac_reach_m = reachOfSac(heart, sacs);
  for (const Part& part : shapes.front().parts)
    recording.parts.push_back({part.kind, part.faces, tagsOf(part), {}, {}});
  parallelBlocks(recording.parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const LoopFit fit = fitOf(shapes.front().parts[p], recording.parts[p].tags);
      std::vector<std::vector<Vec3d>> instants;
      for (std::size_t k = 0; k < recording.phases.size(); ++k)
        instants.push_back(std::move(shapes[k].parts[p].points));
      recording.parts[p].control_m = controlPoints(fit, instants);
    }
  });
  for (std::size_t k = 0; k < recording.phases.size(); ++k)
    recording.places.push_back(shapes[k].places);
  repairFolds(recording);
  recording.body_scale = heart.parameters().body_scale;
  recording.pose = poseOf(view, recording);
  return recording;
}

Recording record(const ParametricHeart& heart, View view, int keyframes, KeyframeSpacing spacing,
                 const Monitor& monitor) {
  Recording recording = recordBeat(heart, view, keyframes, spacing, monitor);
  surround(view, recording.pose, heart, recording);
  measureVolumes(recording);
  return recording;
}

void surround(View view, const ProbePose& pose, const ParametricHeart& heart,
              Recording& recording) {
  std::erase_if(recording.parts,
                [](const RecordedPart& part) { return part.control_m.size() == 1; });
  Recording still;
  still.phases = recording.phases;
  for (const Part& part : surroundingsOf(view, pose, heart, recording.sac_reach_m))
    still.parts.push_back(
        {part.kind, part.faces, {}, controlPoints(fitOf(part, {}), {&part.points, 1}), {}});
  repairFolds(still);
  std::move(still.parts.begin(), still.parts.end(), std::back_inserter(recording.parts));
}

}  // namespace echocine::heart
