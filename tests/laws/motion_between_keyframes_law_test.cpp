// Between keyframes of whole hearts: nothing breaks, and a judgement of the kinds of interpolation.

#include <fmt/format.h>

#include "core/parallel.h"
#include "core/units.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/keyframes/interpolation_judge.h"
#include "motion/mesh/mesh_io.h"
#include "motion/surfaces/motion_warnings.h"
#include "output/heart_files.h"
#include "scene/scene_reader.h"
#include "tests/stage/motion_fixtures.h"
#include "tests/support/paths.h"
#include "tests/support/temp_folder.h"

namespace echocine::motion_test {
namespace {

namespace fs = std::filesystem;

const fs::path kMeshes = fs::path(support::kSharedDir) / "real/meshes";
const fs::path kPatient = kMeshes / "bivme_patient1_25f";

// Every n-th keyframe of a sequence whose files are <name>_000.obj, ...
Structure sequence(const fs::path& folder, const std::vector<std::string>& names, int count,
                   int step = 1) {
  Structure structure;
  structure.name = names.front();
  for (int k = 0; k < count; k += step) {
    Keyframe keyframe{{}, static_cast<double>(k) / count};
    for (const std::string& name : names)
      keyframe.files.push_back(folder / fmt::format("{}_{:03}.obj", name, k));
    structure.keyframes.push_back(keyframe);
  }
  return structure;
}

Scene patient(int step = 1) {
  Scene scene = sceneOf(sequence(
      kPatient, {"epi", "mitral_valve", "aortic_valve", "tricuspid_valve", "pulmonary_valve"}, 25,
      step));
  scene.structures.push_back(sequence(kPatient, {"lv_endo_closed"}, 25, step));
  scene.structures.push_back(sequence(kPatient, {"rv_endo_closed"}, 25, step));
  scene.motion.mesh_unit_m = 1e-3;
  return scene;
}

Scene shippedHeart() {
  return readScene(fs::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
}

// About a thousand phases of one beat, hardly any of them a keyframe's; fewer where sanitizers make
// each of them slow.
#ifdef NDEBUG
constexpr double kPhases = 1009;
#else
constexpr double kPhases = 211;
#endif
// What motionWarnings() tells with each kind.
std::vector<std::vector<std::string>> toldOfEveryKind(Scene scene) {
  scene.acquisition = {.heart_rate_hz = 1, .frame_rate_hz = kPhases, .beats = 1};
  std::vector<std::vector<std::string>> told;
  for (const Interpolation kind : kInterpolations) {
    // Trigonometric polynomials do not go through keyframes as uneven as the shipped heart's.
    if (kind == Interpolation::fourier && !scene.motion.keyframe_phases.empty()) continue;
    scene.motion.interpolation = kind;
    told.push_back(motionWarnings(scene, MeshMotion(scene)));
  }
  return told;
}

bool isOfVolume(const std::string& warning) {
  return warning.find(" mL over both adjacent keyframes, ") != std::string::npos ||
         warning.find(" mL under both adjacent keyframes, ") != std::string::npos;
}

// Nothing folds, vanishes or collapses. A smooth kind that finds its extreme between two keyframes
// is over 1 % of the end-diastolic volume beyond both at times, which is told and breaks nothing.
void expectWhole(const Scene& scene) {
  for (const std::vector<std::string>& told : toldOfEveryKind(scene))
    for (const std::string& warning : told) EXPECT_TRUE(isOfVolume(warning)) << warning;
}

// Neither the interpolation of the scene nor the default one gives a warning.
void expectSilent(Scene scene) {
  scene.acquisition = {.heart_rate_hz = 1, .frame_rate_hz = kPhases, .beats = 1};
  EXPECT_EQ(motionWarnings(scene, MeshMotion(scene)), std::vector<std::string>{});
  scene.motion.interpolation = MotionSettings{}.interpolation;
  EXPECT_EQ(motionWarnings(scene, MeshMotion(scene)), std::vector<std::string>{});
}

struct Judged {
  std::array<InterpolationError, kInterpolationKinds> of;
};

Judged judgedOverall(const Scene& scene) {
  const MeshMotion motion(scene);
  Judged judged;
  for (std::size_t k = 0; k < kInterpolationKinds; ++k) {
    std::vector<InterpolationError> errors;
    for (const SurfaceTopology& surface : motion.surfaces())
      if (const auto e = judgeInterpolation(motion.control(surface.id), kInterpolations[k]))
        errors.push_back(*e);
    judged.of[k] = pooled(errors);
    std::printf("  kind %d: %.3f mm RMS, %.3f mL RMS, %.3f mL at most, %.2f %%\n",
                static_cast<int>(k), millimetresFromMetres(judged.of[k].vertex_rms_m),
                millilitresFromCubicMetres(judged.of[k].volume_rms_m3),
                millilitresFromCubicMetres(judged.of[k].volume_max_m3),
                100 * judged.of[k].volume_max_share);
  }
  return judged;
}

class MotionBetweenKeyframes : public testing::Test {
 protected:
  void needReal() {
    if (!fs::is_directory(kMeshes)) GTEST_SKIP() << kMeshes << " is not there";
  }
};

TEST_F(MotionBetweenKeyframes, ShippedHeartStaysWholeWithEveryKind) {
  expectWhole(shippedHeart());
  expectSilent(shippedHeart());
}

TEST_F(MotionBetweenKeyframes, PatientStaysWholeWithEveryKindAndWithHalfTheKeyframes) {
  needReal();
  if (IsSkipped()) return;
  expectWhole(patient());
  expectWhole(patient(2));
  expectSilent(patient());
}

TEST_F(MotionBetweenKeyframes, SyntheticHeartOf36FramesStaysWhole) {
  needReal();
  if (IsSkipped()) return;
  const fs::path folder = kMeshes / "simrender_heart_36f";
  Scene scene = sceneOf({});
  Structure& heart = scene.structures[0];
  heart.name = "heart";
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".obj") heart.keyframes.push_back({{entry.path()}, 0});
  std::sort(heart.keyframes.begin(), heart.keyframes.end(),
            [](const Keyframe& a, const Keyframe& b) { return a.files < b.files; });
  for (std::size_t k = 0; k < heart.keyframes.size(); ++k)
    heart.keyframes[k].phase = static_cast<double>(k) / static_cast<double>(heart.keyframes.size());
  scene.motion.mesh_unit_m = 1e-3;
  expectWhole(scene);
}

TEST_F(MotionBetweenKeyframes, AHeartThatTurnsByAQuarterFromKeyframeToKeyframeStaysWhole) {
  needReal();
  if (IsSkipped()) return;
  const TestFolder folder;
  Sha256 digest;
  const TriangleMesh heart = readMesh(kPatient / "rv_endo_closed_000.obj", digest);
  const Vec3d centre = heart.positions.front();
  std::vector<TriangleMesh> keyframes(4, heart);
  for (std::size_t quarter = 1; quarter < 4; ++quarter)
    for (std::size_t v = 0; v < heart.positions.size(); ++v) {
      const Vec3d d = keyframes[quarter - 1].positions[v] - centre;
      keyframes[quarter].positions[v] = centre + Vec3d{-d.y, d.x, d.z};
    }
  Scene scene = sceneWith(folder, keyframes, Interpolation::linear);
  scene.motion.mesh_unit_m = 1e-3;
  // It stays whole, but on straight lines a quarter turn passes half the cross-section: told of
  // every kind, and no kind is advised that would lose as much.
  for (const std::vector<std::string>& told : toldOfEveryKind(scene)) {
    EXPECT_LE(told.size(), 1u);
    for (const std::string& warning : told) {
      EXPECT_TRUE(isOfVolume(warning)) << warning;
      EXPECT_TRUE(warning.ends_with(": keyframes closer in time are needed")) << warning;
    }
  }
}

// The parametric heart with keyframes spaced evenly, as every kind can take them.
Judged judgedParametricHeart() {
  support::TempFolder folder;
  HeartFiles wanted;
  wanted.spacing = heart::KeyframeSpacing::even;
  writeHeart(wanted, folder.path() / "heart");
  return judgedOverall(readScene(folder.path() / "heart/scene.toml"));
}

// Vertices and volumes of both hearts count alike: the geometric mean of the four errors.
TEST_F(MotionBetweenKeyframes, TheDefaultKindErrsLeastOnBothHeartsTogether) {
  needReal();
  if (IsSkipped()) return;
  const Judged real = judgedOverall(patient()), model = judgedParametricHeart();
  const auto together = [&](std::size_t kind) {
    double product = 1;
    for (const Judged& heart : {real, model})
      product *= heart.of[kind].vertex_rms_m * heart.of[kind].volume_rms_m3;
    return product;
  };
  const auto chosen = static_cast<std::size_t>(MotionSettings{}.interpolation);
  for (std::size_t kind = 0; kind < kInterpolationKinds; ++kind)
    EXPECT_GE(together(kind), together(chosen)) << "kind " << kind;
  // The sizes that README states.
  EXPECT_LT(real.of[chosen].volume_max_share, 0.03);
  EXPECT_LT(real.of[chosen].vertex_rms_m, 1.6e-3);
  EXPECT_LT(model.of[chosen].vertex_rms_m, 0.4e-3);
}

}  // namespace
}  // namespace echocine::motion_test
