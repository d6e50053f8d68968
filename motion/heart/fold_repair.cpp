#include "motion/heart/fold_repair.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "motion/heart/heart_units.h"
#include "motion/heart/unfold.h"

namespace echocine::heart {
namespace {

// The dial with most influence on a part.
const char* dialOf(std::string_view part) {
  const auto begins = [part](std::string_view with) { return part.substr(0, with.size()) == with; };
  if (begins("lv_cavity") || begins("papillary")) return "ef";
  if (begins("lv_")) return "wall-thickness";
  if (begins("rv_") || begins("pulmonary")) return "rv-edv";
  if (begins("la")) return "la-volume";
  if (begins("ra")) return "ra-volume";
  return "body-scale";
}

std::vector<double> volumesOf(const RecordedPart& part) {
  std::vector<double> volumes_m3;
  for (const std::vector<Vec3d>& points : part.control_m)
    volumes_m3.push_back(volumeOf(points, part.faces));
  return volumes_m3;
}

// The remaining fault of a part after its folds were smoothed; empty if there is none.
std::string mend(RecordedPart& part, const std::vector<double>& phases) {
  const SurfaceBeat beat{phases, part.control_m};
  Folds folds(beat, part.faces);
  if (!folds.first()) return {};
  const std::vector<double> before_m3 = volumesOf(part);
  const std::optional<Fold> left = folds.smooth();
  for (std::vector<Vec3d>& points : part.control_m)
    for (Vec3d& point : points) point = toMicrometre(point);
  const char* const dial = dialOf(part.kind.name);
  if (left)
    return fmt::format(
        "{}: {} folds at phase {:.2f} between its neighbours; choose another {}, or dials closer "
        "to their defaults",
        dial, part.kind.name, phases[left->keyframe], dial);
  const double accepted = part.kind.name == "lv_cavity" ? 0.001 : 0.1;
  const std::vector<double> after_m3 = volumesOf(part);
  for (std::size_t k = 0; k < after_m3.size(); ++k)
    if (!(std::abs(after_m3[k] - before_m3[k]) <= accepted * std::abs(before_m3[k])))
      return fmt::format(
          "{}: {} of {:.3g} mL does not fit this heart without folds: it would have {:.3g}; choose "
          "another {}, or dials closer to their defaults",
          dial, part.kind.name, before_m3[k] / kMillilitre, after_m3[k] / kMillilitre, dial);
  return {};
}

}  // namespace

void repairFolds(Recording& recording) {
  std::vector<std::string> faults(recording.parts.size());
  parallelBlocks(recording.parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (!recording.parts[p].kind.membrane) faults[p] = mend(recording.parts[p], recording.phases);
  });
  for (const std::string& fault : faults)  // the first one, independent of the threads
    if (!fault.empty()) throw SceneError(fault);
}

}  // namespace echocine::heart
