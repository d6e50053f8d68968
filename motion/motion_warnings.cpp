#include "motion/motion_warnings.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/keyframes/motion_check.h"

namespace echocine {

namespace {

// Phases as equal as the clock makes those of whole beats; 1e-9 of a beat is 1 ns.
constexpr double kSamePhase = 1e-9;

// The loop's frames, one for each phase: the earliest.
std::vector<FramePhase> differentFrames(const Acquisition& acquisition) {
  const CardiacClock clock(acquisition);
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
      words = fmt::format("{} turns over between there and {}, in one of which it lies folded",
                          face, next);
      break;
    case TriangleBreak::turned:
      words = fmt::format("{} is turned over on the way to {}", face, next);
      break;
    case TriangleBreak::vanished:
      words = fmt::format("{} shrinks to nothing on the way to {}", face, next);
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

std::string advice(const SurfaceBreaks& breaks, Interpolation kind) {
  if (breaks.first && breaks.first->kind == TriangleBreak::mirrored)
    return "mend one of the two files";
  return kind == Interpolation::linear || breaks.collapsed
             ? "keyframes closer in time are needed"
             : "keyframes closer in time or motion.interpolation = \"linear\" avoid it";
}

[[noreturn]] void refuse(const Structure& structure, const ControlMotion& motion,
                         const SurfaceBreaks::Size& size, Interpolation kind) {
  throw JobError(atPlace(
      structure.place,
      fmt::format("{}: frame {}: encloses {:.4g} mL between {} and {}: it turns inside out on the "
                  "way, a volume over 0 is accepted: {}",
                  structure.name, size.frame, millilitresFromCubicMetres(size.volume_m3),
                  motion.fileOf(size.left), motion.fileOf(size.right), advice({}, kind))));
}

}  // namespace

std::vector<std::string> motionWarnings(const Scene& scene, const MeshMotion& motion) {
  const std::vector<FramePhase> frames = differentFrames(scene.acquisition);
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
    if (!words.empty())
      warnings.push_back(atPlace(
          structure.place, fmt::format("{}: {}: {}", structure.name, words, advice(breaks, kind))));
  }
  return warnings;
}

}  // namespace echocine
