// A real patient's heart, 25 frames of cine MR: what is read encloses what its makers say it does.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "core/units.h"
#include "motion/mesh/mesh_io.h"
#include "motion/surfaces/mesh_motion.h"
#include "tests/stage/motion_fixtures.h"
#include "tests/support/paths.h"

namespace echocine::motion_test {
namespace {

const std::filesystem::path kReal = std::filesystem::path(support::kSharedDir) / "real";

// mL at frames 0..24, as published with the meshes.
constexpr std::array<double, 25> kLeft_ml{
    174.5, 169.4, 156.2, 140.2, 121.8, 107.0, 96.8,  82.0,  79.0,  72.0,  77.5,  80.3, 88.1,
    104.3, 119.2, 135.7, 144.8, 150.2, 150.1, 147.6, 146.1, 149.1, 154.6, 170.1, 179.0};
constexpr std::array<double, 25> kRight_ml{
    170.1, 165.3, 154.0, 141.8, 129.0, 114.2, 101.6, 87.7,  82.7,  76.7,  77.6,  78.2, 82.0,
    99.3,  118.0, 122.2, 128.5, 133.0, 135.3, 136.2, 142.0, 146.9, 158.2, 167.0, 167.8};

Structure patientStructure(const std::vector<std::string>& names) {
  Structure structure;
  structure.name = names.front();
  structure.place = {"scene.toml", 7, "structure.keyframes"};
  for (int k = 0; k < 25; ++k) {
    Keyframe keyframe{{}, k / 25.0};
    for (const std::string& name : names)
      keyframe.files.push_back(kReal / "meshes/bivme_patient1_25f" /
                               fmt::format("{}_{:03}.obj", name, k));
    structure.keyframes.push_back(keyframe);
  }
  return structure;
}

Scene patientScene(const Structure& structure) {
  Scene scene = sceneOf(structure);
  scene.motion.mesh_unit_m = 1e-3;
  return scene;
}

std::vector<double> volumes_ml(const MeshMotion& motion, int count) {
  std::vector<double> volumes;
  SurfaceFrame frame;
  for (int i = 0; i < count; ++i) {
    motion.frameAt(static_cast<double>(i) / count, frame);
    volumes.push_back(
        millilitresFromCubicMetres(enclosedVolume(motion.surfaces()[0], frame.positions_m[0])));
  }
  return volumes;
}

int extremumCount(const std::vector<double>& curve) {
  int count = 0;
  for (std::size_t i = 0, n = curve.size(); i < n; ++i) {
    const double before = curve[(i + n - 1) % n], here = curve[i], after = curve[(i + 1) % n];
    count += (here - before) * (after - here) < 0;
  }
  return count;
}

class MotionPatientLaw : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(kReal)) GTEST_SKIP() << kReal << " is not there";
  }
};

// The publishers' numbers of the same meshes: units, orientation and lids are right or these are
// not.
TEST_F(MotionPatientLaw, CavityVolumesAreThePublishedOnes) {
  const auto left = volumes_ml(MeshMotion(patientScene(patientStructure({"lv_endo_closed"}))), 25);
  const auto right = volumes_ml(MeshMotion(patientScene(patientStructure({"rv_endo_closed"}))), 25);
  for (std::size_t k = 0; k < 25; ++k) {
    EXPECT_NEAR(left[k], kLeft_ml[k], 0.01 * kLeft_ml[k]) << k;
    EXPECT_NEAR(right[k], kRight_ml[k], 0.01 * kRight_ml[k]) << k;
  }
}

// The outer surface holds both cavities and 145 to 178 mL of wall.
TEST_F(MotionPatientLaw, FourLidsCloseTheEpicardium) {
  const MeshMotion motion(patientScene(patientStructure(
      {"epi", "mitral_valve", "aortic_valve", "tricuspid_valve", "pulmonary_valve"})));
  EXPECT_EQ(leakCount(motion.surfaces()[0].triangles), 0u);
  const std::vector<double> outer = volumes_ml(motion, 25);
  for (std::size_t k = 0; k < 25; ++k) {
    const double wall_ml = outer[k] - kLeft_ml[k] - kRight_ml[k];
    EXPECT_GT(wall_ml, 144.0) << k;
    EXPECT_LT(wall_ml, 179.0) << k;
  }
}

TEST_F(MotionPatientLaw, WithoutItsLidsTheEpicardiumIsRefused) {
  const std::string error = errorOf([] { MeshMotion{patientScene(patientStructure({"epi"}))}; });
  EXPECT_NE(error.find("epi_000.obj: face "), std::string::npos) << error;
  EXPECT_NE(error.find("lids which close it"), std::string::npos) << error;
}

// Interpolation must not invent wall motion: the left ventricle's volume turns between frames only
// as often as it does from frame to frame.
TEST_F(MotionPatientLaw, LeftVolumeGainsNoExtremumBetweenKeyframes) {
  for (const Interpolation kind : {MotionSettings{}.interpolation, Interpolation::catmull_rom}) {
    Scene scene = patientScene(patientStructure({"lv_endo_closed"}));
    scene.motion.interpolation = kind;
    const MeshMotion motion(scene);
    EXPECT_EQ(extremumCount(volumes_ml(motion, 1000)), extremumCount(volumes_ml(motion, 25)));
  }
}

// Between two frames a smooth curve may leave the span of their volumes, where the beat turns
// sharply, but by less than 1 % of the stroke volume of about 100 mL.
// Smooth interpolation overshoots; by how much is what a user of volumes must know.
TEST_F(MotionPatientLaw, VolumeOvershootsKeyframesByLessThanAMillilitre) {
  constexpr std::size_t kSteps = 20;
  for (const char* name : {"lv_endo_closed", "rv_endo_closed"})
    for (const Interpolation kind : {Interpolation::linear, Interpolation::catmull_rom,
                                     Interpolation::spline, Interpolation::fourier}) {
      Scene scene = patientScene(patientStructure({name}));
      scene.motion.interpolation = kind;
      const std::vector<double> curve = volumes_ml(MeshMotion(scene), 25 * kSteps);
      for (std::size_t i = 0; i < curve.size(); ++i) {
        const std::size_t left = i - i % kSteps, right = (left + kSteps) % curve.size();
        EXPECT_GT(curve[i], std::min(curve[left], curve[right]) - 1.0) << name << ' ' << i;
        EXPECT_LT(curve[i], std::max(curve[left], curve[right]) + 1.0) << name << ' ' << i;
      }
    }
}

TEST_F(MotionPatientLaw, SubdivisionKeepsTheVolume) {
  Scene scene = patientScene(patientStructure({"lv_endo_closed"}));
  scene.motion.subdivision = 2;
  const MeshMotion motion(scene);
  EXPECT_EQ(motion.surfaces()[0].triangles.size(), 16u * 3144u);
  EXPECT_NEAR(volumes_ml(motion, 1)[0], kLeft_ml[0], 0.01 * kLeft_ml[0]);
}

TEST_F(MotionPatientLaw, AnotherUnitIsNoticedWhenItIsImplausible) {
  Scene scene = patientScene(patientStructure({"lv_endo_closed"}));
  scene.motion.mesh_unit_m = 1;
  EXPECT_NE(errorOf([&] { MeshMotion{scene}; }).find("correct motion.mesh_unit"),
            std::string::npos);
}

TEST_F(MotionPatientLaw, NastyMeshesAreRefusedAndCleanOnesRead) {
  const auto says = [](const std::string& file) {
    return errorOf([&] { MeshMotion{patientScene(structureOf({kReal / file}))}; });
  };
  const std::string soup = says("robustness/cardiomesh_LV4396_nonmanifold.obj");
  EXPECT_NE(soup.find("belongs to"), std::string::npos) << soup;
  EXPECT_NE(says("robustness/slicerheart_marker_open_nonmanifold.obj"), "no error");
  EXPECT_NE(says("robustness/legacy_biv_output.001.vtk").find("obj, ply, off, stl and npz"),
            std::string::npos);
  EXPECT_EQ(says("robustness/slicerheart_AL_Papillary_Post.stl"), "no error");
}

}  // namespace
}  // namespace echocine::motion_test
