#include "scene/white_rule.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/units.h"
#include "scene/grey_curve.h"
#include "scene/role.h"

namespace echocine {

namespace {

bool isMuscle(Role role) {
  switch (role) {
    case Role::lv_wall:
    case Role::rv_wall:
    case Role::la_wall:
    case Role::ra_wall:
    case Role::papillary_muscle:
    case Role::epicardium:
      return true;
    default:
      return false;
  }
}

bool isChamber(Role role) {
  return role == Role::lv_cavity || role == Role::rv_cavity || role == Role::la || role == Role::ra;
}

}  // namespace

std::vector<char> muscleMedia(const Scene& scene) {
  std::vector<char> muscle(scene.media.size());
  bool heart = false, walls = false;
  for (const Structure& s : scene.structures) {
    if (s.membrane) continue;
    const Role role = roleOf(s);
    const bool is_wall = isMuscle(role) || scene.medium(s.medium).name == "myocardium";
    heart = heart || isMuscle(role) || isChamber(role);
    walls = walls || is_wall;
    if (is_wall) muscle[index(s.medium)] = 1;
  }
  if (!heart) return std::vector<char>(scene.media.size());
  if (!walls) muscle[index(scene.background)] = 1;
  for (const Structure& s : scene.structures)
    if (!s.membrane && isChamber(roleOf(s))) muscle[index(s.medium)] = 0;
  return muscle;
}

bool isWhiteByMuscle(const Scene& scene) {
  if (scene.signal.reference_intensity || scene.signal.reference_percentile != kWhiteByMuscle)
    return false;
  const std::vector<char> muscle = muscleMedia(scene);
  return std::find(muscle.begin(), muscle.end(), 1) != muscle.end();
}

std::string whiteWords(const Scene& scene) {
  if (scene.signal.reference_intensity) return "signal.reference_intensity";
  const double asked = scene.signal.reference_percentile;
  const std::string percentile = fmt::format("percentile {:g} of all samples, near field left out",
                                             asked == kWhiteByMuscle ? kDefaultPercentile : asked);
  if (!isWhiteByMuscle(scene)) return percentile;
  return fmt::format("median of the heart muscle at grey {:g}; with hardly any in view {}",
                     kMuscleGrey, percentile);
}

double whiteOverMuscle(const SignalSettings& signal) {
  const double place = GreyCurve(signal).inverse(kMuscleGrey / 255);  // in the dynamic range
  return intensityFromDecibels((1 - place) * signal.dynamic_range_db);
}

}  // namespace echocine
