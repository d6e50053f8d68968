#include "scene/structure_reader.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cctype>

#include "scene/key_reader.h"
#include "scene/npz_keyframe.h"
#include "scene/ranges.h"

namespace echocine {

namespace {

namespace fs = std::filesystem;

// Compares digits by their value, so that frame_9 stands before frame_10.
bool naturalLess(const std::string& a, const std::string& b) {
  const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (isDigit(a[i]) && isDigit(b[j])) {
      std::size_t i_end = i, j_end = j;
      while (i_end < a.size() && isDigit(a[i_end])) ++i_end;
      while (j_end < b.size() && isDigit(b[j_end])) ++j_end;
      while (i < i_end - 1 && a[i] == '0') ++i;
      while (j < j_end - 1 && b[j] == '0') ++j;
      if (i_end - i != j_end - j) return i_end - i < j_end - j;
      const int order = a.compare(i, i_end - i, b, j, j_end - j);
      if (order != 0) return order < 0;
      i = i_end;
      j = j_end;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;
}

// Where keyframes are looked for.
struct MeshSource {
  const fs::path& folder;
  const NamedMeshes* in_memory;  // nullptr: in the folder
};

void sortNaturally(std::vector<fs::path>& files) {
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return naturalLess(a.filename().string(), b.filename().string());
  });
}

std::vector<fs::path> matchingMeshes(const TomlTable& table, std::string_view key,
                                     const NamedMeshes& meshes, const std::string& pattern) {
  std::vector<fs::path> names;
  for (const auto& [name, mesh] : meshes)
    if (fnmatch(pattern.c_str(), name.c_str(), 0) == 0) names.emplace_back(name);
  if (names.empty()) table.fail(key, fmt::format("no mesh in memory matches {}", pattern));
  sortNaturally(names);
  return names;
}

// A .npz file is replaced by the names of its keyframes.
std::vector<fs::path> keyframesIn(const TomlTable& table, std::string_view key,
                                  const std::vector<fs::path>& files) {
  std::vector<fs::path> names;
  for (const fs::path& file : files) {
    const auto npz = npzKeyframeOf(file);
    if (!npz || npz->keyframe) {
      names.push_back(file);
      continue;
    }
    try {
      const std::vector<fs::path> all = npzKeyframeNames(file);
      names.insert(names.end(), all.begin(), all.end());
    } catch (const SceneError& error) {
      table.fail(key, error.what());
    }
  }
  return names;
}

// The files that match a pattern, sorted; wild cards are allowed in the file name only.
std::vector<fs::path> matchingFiles(const TomlTable& table, std::string_view key,
                                    const MeshSource& source, const std::string& pattern) {
  if (source.in_memory) return matchingMeshes(table, key, *source.in_memory, pattern);
  const fs::path& folder = source.folder;
  const fs::path full = fs::path(pattern).is_absolute() ? fs::path(pattern) : folder / pattern;
  if (npzKeyframeOf(full) && full.filename().string().find_first_of("*?") == std::string::npos)
    return keyframesIn(table, key, {full});
  if (full.filename().string().find_first_of("*?[") == std::string::npos) return {full};
  std::error_code failed;
  std::vector<fs::path> files;
  // A scene named without a folder has an empty one, which no system call takes for the current
  // folder.
  const fs::path parent = full.has_parent_path() ? full.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(parent, failed))
    if (fnmatch(full.filename().c_str(), entry.path().filename().c_str(), 0) == 0)
      files.push_back(full.parent_path() / entry.path().filename());
  if (failed == std::errc::not_enough_memory) throw std::bad_alloc();
  if (failed)
    table.fail(key, fmt::format("folder {} cannot be read: {}", full.parent_path().string(),
                                failed.message()));
  if (files.empty()) table.fail(key, fmt::format("no file matches {}", full.string()));
  sortNaturally(files);
  return keyframesIn(table, key, files);
}

std::vector<Keyframe> readPhasedKeyframes(TomlTable& table, const MeshSource& source) {
  std::vector<Keyframe> keyframes;
  for (TomlTable& entry : table.tables("keyframes")) {
    const std::string named = entry.text("file");
    if (source.in_memory && !source.in_memory->contains(named))
      entry.fail("file", fmt::format("no mesh in memory has the name {}", named));
    const fs::path file =
        source.in_memory || fs::path(named).is_absolute() ? fs::path(named) : source.folder / named;
    const double phase = entry.number("phase", std::nullopt, {.lo = 0, .hi = 1});
    if (phase == 1)
      entry.fail("phase",
                 keyframes.empty()
                     ? "is 1, accepted: at least 0 and below 1"
                     : "is 1, the beat's start again: drop the frame that "
                       "closes the beat, the first keyframe follows the last automatically");
    if (!keyframes.empty() && !(phase - keyframes.back().phase >= ranges::kLeastPhaseStep))
      entry.fail("phase",
                 fmt::format("is {} after {}, accepted: ascending phases, {} apart or more", phase,
                             keyframes.back().phase, ranges::kLeastPhaseStep));
    entry.finish();
    keyframes.push_back({{file}, phase});
  }
  return keyframes;
}

// A structure of one keyframe stands still, whatever the phases of the others.
std::vector<Keyframe> readPlainKeyframes(TomlTable& table, const MeshSource& source,
                                         std::span<const double> phases) {
  std::vector<Keyframe> keyframes;
  for (const std::string& pattern : table.texts("keyframes"))
    for (const fs::path& file : matchingFiles(table, "keyframes", source, pattern))
      keyframes.push_back({{file}, 0});
  const bool given = !phases.empty() && keyframes.size() > 1;
  if (given && phases.size() != keyframes.size())
    table.fail("keyframes", fmt::format("{} keyframes, accepted: as many as motion.keyframe_phases "
                                        "has, {}, or one for a static structure",
                                        keyframes.size(), phases.size()));
  for (std::size_t i = 0; i < keyframes.size(); ++i)
    keyframes[i].phase =
        given ? phases[i] : static_cast<double>(i) / static_cast<double>(keyframes.size());
  return keyframes;
}

void addLids(TomlTable& table, const MeshSource& source, std::vector<Keyframe>& keyframes) {
  for (const std::string& pattern : table.texts("lids")) {
    const std::vector<fs::path> files = matchingFiles(table, "lids", source, pattern);
    if (files.size() != keyframes.size())
      table.fail("lids",
                 fmt::format("{} names {} files, accepted: one for each of the {} keyframes",
                             pattern, files.size(), keyframes.size()));
    for (std::size_t i = 0; i < files.size(); ++i) keyframes[i].files.push_back(files[i]);
  }
}

void takeMeshes(const NamedMeshes& meshes, std::vector<Keyframe>& keyframes) {
  for (Keyframe& keyframe : keyframes)
    for (const fs::path& name : keyframe.files) keyframe.meshes.push_back(meshes.at(name.string()));
}

Repairs readRepairs(TomlTable& table, bool membrane) {
  Repairs repairs;
  const std::vector<std::pair<std::string, bool Repairs::*>> words{
      {"weld", &Repairs::weld},
      {"orient", &Repairs::orient},
      {"drop-degenerate", &Repairs::drop_degenerate},
      {"split", &Repairs::split},
      {"fill-holes", &Repairs::fill_holes}};
  std::vector<std::string> names;
  for (const auto& word : words) names.push_back(word.first);
  for (const std::string& asked : table.texts("repair")) {
    const auto found = std::find(names.begin(), names.end(), asked);
    if (found == names.end()) {
      const std::string nearest = nearestWord(asked, names);
      table.fail("repair",
                 fmt::format("holds \"{}\", accepted: \"{}\"{}", asked, fmt::join(names, "\" | \""),
                             nearest.empty() ? "" : fmt::format("; nearest: {}", nearest)));
    }
    repairs.*words[static_cast<std::size_t>(found - names.begin())].second = true;
  }
  if (membrane && repairs.fill_holes)
    table.fail("repair",
               "holds \"fill-holes\", which would close an open sheet, accepted for a membrane: "
               "\"weld\" | \"orient\" | \"drop-degenerate\" | \"split\"");
  return repairs;
}

}  // namespace

Structure readStructure(TomlTable& table, const fs::path& folder, std::span<const double> phases,
                        const NamedMeshes* meshes) {
  const MeshSource source{folder, meshes};
  Structure structure;
  structure.name = table.text("name");
  if (structure.name.empty()) table.fail("name", "is empty, accepted: a name");
  structure.role_given = table.has("role");
  structure.role = guessRole(structure.name);
  readKeys(table, "structure", {.structure = &structure});
  structure.phases_given = table.isListOfTables("keyframes");
  structure.keyframes = structure.phases_given ? readPhasedKeyframes(table, source)
                                               : readPlainKeyframes(table, source, phases);
  if (structure.keyframes.size() > ranges::kMostKeyframes)
    table.fail("keyframes", fmt::format("are {}, accepted: up to {}", structure.keyframes.size(),
                                        ranges::kMostKeyframes));
  if (structure.keyframes.empty())
    table.fail("keyframes",
               "is missing or empty, accepted: a file pattern, a list of files, or a list of "
               "{file, phase}");
  addLids(table, source, structure.keyframes);
  if (meshes) takeMeshes(*meshes, structure.keyframes);
  structure.repair = readRepairs(table, structure.membrane);
  structure.place = table.place("keyframes");
  return structure;
}

}  // namespace echocine
