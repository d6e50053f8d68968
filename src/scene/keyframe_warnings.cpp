#include "scene/keyframe_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace echocine {

namespace {

using Files = std::set<std::filesystem::path>;

std::string warningOf(const Structure& structure, const std::string& what) {
  return atPlace(structure.place, fmt::format("{}: {}", structure.name, what));
}

Files filesOf(const Structure& structure) {
  Files files;
  for (const Keyframe& keyframe : structure.keyframes)
    files.insert(keyframe.files.front().lexically_normal());
  return files;
}

// la_*.obj is meant for la_00.obj and takes la_wall_00.obj as well.
void warnOfSwallowed(const std::vector<Structure>& structures, std::vector<std::string>& warnings) {
  std::vector<Files> files;
  for (const Structure& structure : structures) files.push_back(filesOf(structure));
  for (std::size_t a = 0; a < structures.size(); ++a)
    for (std::size_t b = 0; b < structures.size(); ++b) {
      if (files[a].size() <= files[b].size() ||
          !std::includes(files[a].begin(), files[a].end(), files[b].begin(), files[b].end()))
        continue;
      warnings.push_back(warningOf(
          structures[a],
          fmt::format("its {} keyframes include all {} of structure {}, such as {}: a pattern that "
                      "matches fewer files (? is one character) separates them",
                      files[a].size(), files[b].size(), structures[b].name,
                      files[b].begin()->string())));
    }
}

// Evenly spaced keyframes of one heart are its states at the same instants: a structure with fewer
// or more than most others has likely lost or caught a file. Still structures and given phases are
// meant.
void warnOfCounts(const std::vector<Structure>& structures, std::vector<std::string>& warnings) {
  std::map<std::size_t, int> structures_with;
  for (const Structure& s : structures)
    if (!s.phases_given && s.keyframes.size() > 1) ++structures_with[s.keyframes.size()];
  const Structure* usual = nullptr;  // the first of those whose number is commonest
  for (const Structure& s : structures)
    if (!s.phases_given && s.keyframes.size() > 1 &&
        (!usual || structures_with[s.keyframes.size()] > structures_with[usual->keyframes.size()]))
      usual = &s;
  for (const Structure& s : structures)
    if (usual && !s.phases_given && s.keyframes.size() > 1 &&
        s.keyframes.size() != usual->keyframes.size())
      warnings.push_back(warningOf(
          s, fmt::format("has {} keyframes, structure {} has {}: each is spread evenly over the "
                         "beat, so their instants differ; {{file, phase}} sets them",
                         s.keyframes.size(), usual->name, usual->keyframes.size())));
}

void warnOfStillness(const Scene& scene, std::vector<std::string>& warnings) {
  const bool moves = std::any_of(scene.structures.begin(), scene.structures.end(),
                                 [](const Structure& s) { return s.keyframes.size() > 1; });
  const Acquisition& a = scene.acquisition;
  const double frames = a.beats * a.frame_rate_hz / a.heart_rate_hz;
  if (moves || scene.structures.empty() || frames < 1.5) return;
  warnings.push_back(
      warningOf(scene.structures.front(),
                fmt::format("every structure has one keyframe, so the loop's {:.0f} frames are all "
                            "the same: list keyframes, or shorten acquisition.beats",
                            frames)));
}

}  // namespace

std::vector<std::string> keyframeWarnings(const Scene& scene) {
  std::vector<std::string> warnings;
  warnOfSwallowed(scene.structures, warnings);
  warnOfCounts(scene.structures, warnings);
  warnOfStillness(scene, warnings);
  return warnings;
}

}  // namespace echocine
