#include "motion/surfaces/motion_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/units.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/keyframes/motion_check.h"
#include "motion/mesh/surface_measure.h"
#include "scene/role.h"

namespace echocine {

namespace {

// Phases of whole beats that are equal within the clock's rounding; 1e-9 of a beat is 1 ns.
constexpr double kSamePhase = 1e-9;

// The loop's frames, one for each phase: the earliest.
std::vector<FramePhase> differentFrames(const Scene& scene) {
  const CardiacClock clock(scene);
  std::vector<FramePhase> frames;
  for (int i = 0; i < clock.frameCount(); ++i) frames.push_back({i, clock.at(i).phase});
  std::stable_sort(frames.begin(), frames.end(),
                   [](const FramePhase& a, const FramePhase& b) { return a.phase < b.phase; });
  std::vector<FramePhase> different;
  for (const FramePhase& frame : frames) {
    if (different.empty() || frame.phase - different.back().phase > kSamePhase)
      different.push_back(frame);
    else
      different.back().frame = std::min(different.back().frame, frame.frame);
  }
  return different;
}

std::string triangleWords(const ControlMotion& motion, const SurfaceBreaks& breaks) {
  const SurfaceBreaks::First& first = *breaks.first;
  const std::string face = motion.faceName(first.left, first.triangle);
  const std::string next = motion.fileOf(first.right);
  std::string words;
  switch (first.kind) {
    case TriangleBreak::mirrored:
      words = fmt::format("{} turns over between this file and {}; it is folded in one of the two",
                          face, next);
      break;
    case TriangleBreak::turned:
      words = fmt::format("{} is inverted between this file and {}", face, next);
      break;
    case TriangleBreak::vanished:
      words = fmt::format("{} vanishes between this file and {}", face, next);
      break;
  }
  if (breaks.triangles > 1)
    words += fmt::format("; {} more face{} of the structure", breaks.triangles - 1,
                         breaks.triangles > 2 ? "s" : "");
  return fmt::format("frame {}: {}", first.frame, words);
}

std::string collapseWords(const ControlMotion& motion, const SurfaceBreaks::Size& size) {
  return fmt::format("frame {}: has {:.2g} % of the {} of its keyframes {} and {}", size.frame,
                     100 * size.share, motion.membrane ? "area" : "volume",
                     motion.fileOf(size.left), motion.fileOf(size.right));
}

// Reported from this fraction of the end-diastolic volume. Our choice.
constexpr double kToldOvershoot = 0.01;

double largestVolume(const ControlMotion& motion) {
  double largest_m3 = 0;
  for (std::size_t k = 0; k < motion.weights.keyframeCount(); ++k)
    largest_m3 = std::max(largest_m3, enclosedVolume(motion.triangles, motion.rows_m[k]));
  return largest_m3;
}

// The end-diastolic volume of the scene's left ventricle, m^3; in a scene without one, the largest
// keyframe of each structure.
double endDiastolicVolume(const Scene& scene, const MeshMotion& motion, SurfaceId structure) {
  const std::optional<SurfaceId> ventricle = structureOf(scene, Role::lv_cavity);
  return largestVolume(motion.control(ventricle.value_or(structure)));
}

// Excess of a linear blend of two keyframes beyond the range of their volumes, m^3: rotating bodies
// lose volume with any kind of interpolation. From three instants between them.
double straightBeyond(const ControlMotion& motion, std::size_t left, std::size_t right) {
  const std::vector<Vec3f>&a = motion.rows_m[left], &b = motion.rows_m[right];
  const auto at = [&](float share) {
    return enclosedVolume(motion.triangles, [&](std::uint32_t v) {
      return toDouble((1 - share) * a[v] + share * b[v]);
    });
  };
  const double first = at(0), last = at(1);
  double furthest = 0;
  for (const float share : {0.25f, 0.5f, 0.75f}) {
    const double volume = at(share);
    const double beyond =
        std::abs(volume - std::clamp(volume, std::min(first, last), std::max(first, last)));
    furthest = std::max(furthest, beyond);
  }
  return furthest;
}

std::string overshootWords(const ControlMotion& motion, const SurfaceBreaks::Overshoot& found,
                           double end_diastolic_m3) {
  const double told_m3 = kToldOvershoot * end_diastolic_m3;
  if (!(std::abs(found.beyond_m3) > told_m3)) return "";
  const bool straight_stays = straightBeyond(motion, found.left, found.right) <= told_m3;
  return fmt::format(
      "frame {}, phase {:.2f}: {:.2g} mL {} both adjacent keyframes, {} and {}: {}", found.frame,
      found.phase, millilitresFromCubicMetres(std::abs(found.beyond_m3)),
      found.beyond_m3 > 0 ? "over" : "under", motion.fileOf(found.left), motion.fileOf(found.right),
      straight_stays ? "motion.interpolation = \"cycle\" or \"linear\" stays between them"
                     : "keyframes closer in time are needed");
}

// A beat whose last keyframe repeats its first is frozen between the two.
std::string closingWords(const ControlMotion& motion) {
  const std::size_t last = motion.weights.keyframeCount() - 1;
  const auto same = [&](std::size_t k) { return motion.rows_m[k] == motion.rows_m.front(); };
  if (last < 2 || !same(last) || same(last / 2)) return "";
  return fmt::format(
      "{} has the shape of the first keyframe: drop the frame that closes the beat, "
      "the first keyframe follows the last automatically",
      motion.fileOf(last));
}

std::string advice(const SurfaceBreaks& breaks, Interpolation kind) {
  if (breaks.first && breaks.first->kind == TriangleBreak::mirrored)
    return "correct one of the two files";
  return kind == Interpolation::linear || breaks.collapsed
             ? "keyframes closer in time are needed"
             : "keyframes closer in time or motion.interpolation = \"linear\" avoid it";
}

[[noreturn]] void refuse(const Structure& structure, const ControlMotion& motion,
                         const SurfaceBreaks::Size& size, Interpolation kind) {
  throw JobError(
      atPlace(structure.place,
              fmt::format("{}: frame {}: encloses {:.4g} mL between {} and {}: it is inverted in "
                          "between, a positive volume is accepted: {}",
                          structure.name, size.frame, millilitresFromCubicMetres(size.volume_m3),
                          motion.fileOf(size.left), motion.fileOf(size.right), advice({}, kind))));
}

}  // namespace

std::vector<std::string> motionWarnings(const Scene& scene, const MeshMotion& motion) {
  const std::vector<FramePhase> frames = differentFrames(scene);
  const Interpolation kind = scene.motion.interpolation;
  std::vector<std::string> warnings;
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    const Structure& structure = scene.structures[s];
    const ControlMotion& control = motion.control(static_cast<SurfaceId>(s));
    const SurfaceBreaks breaks = findBreaks(control, frames);
    if (breaks.inside_out) refuse(structure, control, *breaks.inside_out, kind);
    std::string words;
    if (breaks.first) words = triangleWords(control, breaks);
    if (breaks.collapsed)
      words += (words.empty() ? "" : "; ") + collapseWords(control, *breaks.collapsed);
    if (!words.empty()) words += ": " + advice(breaks, kind);
    std::string beyond;
    if (breaks.overshoot && !breaks.collapsed)  // a collapse covers it
      beyond = overshootWords(control, *breaks.overshoot,
                              endDiastolicVolume(scene, motion, static_cast<SurfaceId>(s)));
    for (const std::string& told : {words, beyond, closingWords(control)})
      if (!told.empty())
        warnings.push_back(atPlace(structure.place, fmt::format("{}: {}", structure.name, told)));
  }
  return warnings;
}

void refuseInverted(const Scene& scene, const MeshMotion& motion) {
  const std::vector<FramePhase> frames = differentFrames(scene);
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    const ControlMotion& control = motion.control(static_cast<SurfaceId>(s));
    if (const auto found = findInsideOut(control, frames))
      refuse(scene.structures[s], control, *found, scene.motion.interpolation);
  }
}

}  // namespace echocine
