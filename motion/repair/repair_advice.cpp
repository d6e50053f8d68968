#include "motion/repair/repair_advice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>

#include "motion/mesh/mesh_check.h"
#include "motion/mesh/mesh_io.h"
#include "motion/mesh/npz_meshes.h"
#include "motion/repair/mesh_repair.h"

namespace echocine {

namespace {

struct Word {
  const char* name;
  bool Repairs::*asked;
};
constexpr std::array<Word, 5> kWords{{{"weld", &Repairs::weld},
                                      {"drop-degenerate", &Repairs::drop_degenerate},
                                      {"orient", &Repairs::orient},
                                      {"split", &Repairs::split},
                                      {"fill-holes", &Repairs::fill_holes}}};

Repairs repairsOf(unsigned plan) {
  Repairs repairs;
  for (std::size_t w = 0; w < kWords.size(); ++w) repairs.*kWords[w].asked = plan >> w & 1;
  return repairs;
}

unsigned planOf(const Repairs& repairs) {
  unsigned plan = 0;
  for (std::size_t w = 0; w < kWords.size(); ++w)
    if (repairs.*kWords[w].asked) plan |= 1u << w;
  return plan;
}

int wordsIn(unsigned plan) {
  return std::popcount(plan);
}

// All combinations except the scene's own: the shortest first, among equals those that contain the
// scene's words.
std::vector<unsigned> plansFor(const Structure& structure) {
  const unsigned asked = planOf(structure.repair), fill = planOf({.fill_holes = true});
  std::vector<unsigned> plans;
  for (unsigned plan = 1; plan < 1u << kWords.size(); ++plan)
    if (plan != asked && !(structure.membrane && (plan & fill))) plans.push_back(plan);
  std::stable_sort(plans.begin(), plans.end(), [&](unsigned a, unsigned b) {
    if (wordsIn(a) != wordsIn(b)) return wordsIn(a) < wordsIn(b);
    return wordsIn(a & asked) > wordsIn(b & asked);
  });
  return plans;
}

bool hasCornerTwice(const KeyframeMesh& keyframe) {
  return std::any_of(
      keyframe.mesh.triangles.begin(), keyframe.mesh.triangles.end(),
      [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

bool mends(Structure structure, const Repairs& repair, std::vector<KeyframeMesh> keyframes,
           double mesh_unit_m) {
  structure.repair = repair;
  try {
    repairKeyframes(structure, keyframes);
    checkKeyframes(structure, keyframes, mesh_unit_m);
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

// The unmodified keyframes; empty if a file is unusable on its own.
std::vector<KeyframeMesh> rawKeyframes(Structure structure) {
  structure.repair.drop_degenerate = true;  // also reads faces that would be dropped
  std::vector<KeyframeMesh> keyframes;
  const NpzFiles npz({&structure, 1});
  std::vector<std::string> texts;
  try {
    for (const Keyframe& keyframe : structure.keyframes)
      keyframes.push_back(readKeyframe(keyframe, structure, npz, texts));
    checkSameConnectivity(structure, keyframes);
  } catch (const SceneError&) {
    return {};
  }
  return keyframes;
}

}  // namespace

std::optional<Repairs> shortestRepair(const Structure& structure, double mesh_unit_m,
                                      std::size_t most_triangles) {
  const std::vector<KeyframeMesh> raw = rawKeyframes(structure);
  if (raw.empty()) return std::nullopt;
  const bool must_drop = std::any_of(raw.begin(), raw.end(), hasCornerTwice);
  const std::size_t each = raw.size() * raw.front().mesh.triangles.size();
  std::size_t left = most_triangles;
  for (const unsigned plan : plansFor(structure)) {
    const Repairs repair = repairsOf(plan);
    if (must_drop && !repair.drop_degenerate) continue;
    if (each > left) return std::nullopt;
    left -= each;
    if (mends(structure, repair, raw, mesh_unit_m)) return repair;
  }
  return std::nullopt;
}

std::string repairWords(const Repairs& repair) {
  std::vector<std::string> words;
  for (const Word& word : kWords)
    if (repair.*word.asked) words.push_back(fmt::format("\"{}\"", word.name));
  return words.empty() ? "" : fmt::format("repair = [{}]", fmt::join(words, ", "));
}

std::string advised(const SceneError& refusal, const Structure& structure, double mesh_unit_m) {
  const std::optional<Repairs> repair = shortestRepair(structure, mesh_unit_m);
  const std::string words = repair ? repairWords(*repair) : "";
  if (const auto* fault = dynamic_cast<const MeshFault*>(&refusal)) return fault->withRepair(words);
  return words.empty() ? refusal.what() : fmt::format("{}; {} repairs it", refusal.what(), words);
}

}  // namespace echocine
