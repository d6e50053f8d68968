// Channels of motion against the field itself, sample by sample.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "motion/surfaces/interior_motion.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "scene/scene_reader.h"
#include "support/paths.h"
#include "support/patient_scene.h"
#include "support/temp_folder.h"
#include "truth/frame_truth.h"

namespace echocine {
namespace {

// Where the material of a place was: Newton's method, and then steps that need no gradient, as long
// as they come closer. Nothing where it is found turned over, beyond what the group holds.
std::optional<Vec3f> polishedReference(const GroupFrame& group, Vec3f place_m) {
  std::optional<Vec3f> reference = group.reference(place_m, place_m);
  for (int i = 0; reference && i < 8; ++i) {
    const Vec3f left = place_m - group.place(*reference), next = *reference + left;
    if (!(length(place_m - group.place(next)) < length(left))) break;
    *reference = next;
  }
  if (!reference || group.volumeRatio(*reference) <= 0) return std::nullopt;
  return reference;
}

// Whether a structure holds blood, by its anatomy.
bool isLumen(Role role) {
  constexpr Role kLumens[] = {Role::lv_cavity, Role::rv_cavity, Role::la,
                              Role::ra,        Role::aorta,     Role::pulmonary_artery};
  return std::find(std::begin(kLumens), std::end(kLumens), role) != std::end(kLumens);
}

struct Agreement {
  std::vector<double> miss_mm, miss_mm_s;  // ascending
  std::size_t samples = 0, unknown = 0;
};

Agreement agreementOf(Scene scene) {
  constexpr double kFirstPhase = 0.05, kStep = 0.001, kSeconds = 0.002;
  scene.probe.lines = 48;
  scene.truth = {};
  scene.output.channels = {Channel::displacement_lateral, Channel::velocity_lateral};
  const MeshMotion motion(scene);
  const TruthMaker maker(scene, motion, {}, kFirstPhase);
  const MotionField& field = *maker.field();
  FieldFrame first, now, before, after;
  field.at(kFirstPhase, first);
  Agreement result;
  for (const double phase : {0.13, 0.35, 0.62, 0.9}) {
    const FrameTruth truth = maker.at({phase, phase - kStep, phase + kStep, kSeconds});
    field.at(phase, now);
    field.at(phase - kStep, before);
    field.at(phase + kStep, after);
    const auto samples = static_cast<std::size_t>(scene.probe.samples);
    for (std::size_t i = 0; i < truth.sample_ids.size(); ++i) {
      const std::uint32_t id = truth.sample_ids[i];
      if (id == 0) continue;
      const Structure& structure = scene.structures[id - 1];
      if (isLumen(roleOf(structure))) continue;
      const LineGeometry line = lineGeometry(scene.probe, static_cast<int>(i / samples));
      const double path_m = ScanGeometry(scene.probe).sampleDepth(static_cast<int>(i % samples));
      const Vec3f place = toFloat(line.origin + path_m * line.direction);
      const GroupId group = field.groupOf(static_cast<SurfaceId>(id - 1));
      ++result.samples;
      const auto& moved = truth.motion.displacement_mm;
      const std::optional<Vec3f> reference = polishedReference(now[group], place);
      if (std::isnan(moved[0][i]) || !reference) {
        ++result.unknown;
        continue;
      }
      const auto off = [&](const auto& planes, Vec3f value) {
        const Vec3f found{planes[0][i], planes[2][i], planes[1][i]};
        return static_cast<double>(length(found - value));
      };
      const Vec3f by = place - first[group].place(*reference),
                  run = after[group].place(*reference) - before[group].place(*reference);
      result.miss_mm.push_back(off(moved, 1e3f * by));
      result.miss_mm_s.push_back(
          off(truth.motion.velocity_mm_s, static_cast<float>(1e3 / kSeconds) * run));
    }
  }
  std::sort(result.miss_mm.begin(), result.miss_mm.end());
  std::sort(result.miss_mm_s.begin(), result.miss_mm_s.end());
  return result;
}

// Cubics from side to side of the lattice's cells leave micrometres, more where a cell is bent
// much.
void expectAgreement(const Agreement& a) {
  const std::size_t most = a.miss_mm.size() * 99 / 100;
  std::printf(
      "%zu samples of tissue, %zu of them unknown: 99 %% within %.5f mm and %.4f mm/s, all %.4f "
      "mm\n",
      a.samples, a.unknown, a.miss_mm[most], a.miss_mm_s[most], a.miss_mm.back());
  EXPECT_GT(a.samples, 1000u);
  EXPECT_LT(static_cast<double>(a.unknown), 1e-2 * static_cast<double>(a.samples));
  EXPECT_LT(a.miss_mm[most], 3e-3);
  EXPECT_LT(a.miss_mm[a.miss_mm.size() * 999 / 1000], 0.02);
  EXPECT_LT(a.miss_mm_s[most], 0.1);
}

TEST(MotionChannelsLaw, EverySampleOfTheShippedHeartIsTheFields) {
  expectAgreement(agreementOf(
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml")));
}

TEST(MotionChannelsLaw, EverySampleOfARealHeartIsTheFields) {
  if (!std::filesystem::exists(support::patientMeshes())) GTEST_SKIP() << "no real meshes here";
  const support::TempFolder folder;
  expectAgreement(
      agreementOf(parseScene(support::patientScene().text(), folder.path() / "scene.toml")));
}

}  // namespace
}  // namespace echocine
