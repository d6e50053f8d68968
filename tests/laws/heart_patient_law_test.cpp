// The parametric heart dialled to a real patient, 25 frames of cine MR, and laid onto it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/paths.h"
#include "support/recorded_heart.h"
#include "support/rigid_fit.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

const std::filesystem::path kMeshes =
    std::filesystem::path(support::kSharedDir) / "real/meshes/bivme_patient1_25f";
constexpr std::size_t kEndSystole = 9;  // frame

// mL at frames 0..24, as published with the meshes.
constexpr std::array<double, 25> kLeft_ml{
    174.5, 169.4, 156.2, 140.2, 121.8, 107.0, 96.8,  82.0,  79.0,  72.0,  77.5,  80.3, 88.1,
    104.3, 119.2, 135.7, 144.8, 150.2, 150.1, 147.6, 146.1, 149.1, 154.6, 170.1, 179.0};

const heart::ParametricHeart& patientsHeart() {
  static const heart::ParametricHeart made(heart::parametersFrom({{"edv", 174.5},
                                                                  {"ef", 0.587},
                                                                  {"lv-length", 94.9},
                                                                  {"mapse", 14.3},
                                                                  {"rv-edv", 170.1},
                                                                  {"hr", 72.2}}));
  return made;
}

class HeartPatientLaw : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(kMeshes)) GTEST_SKIP() << kMeshes << " is not there";
  }
};

// In mm, the patient's coordinates.
Mesh patientMesh(const char* name, std::size_t frame) {
  return meshOfObj(bytesOf(kMeshes / fmt::format("{}_{:03}.obj", name, frame)));
}

// Heart coordinates from the patient's by landmarks: origin at the mitral ring, z to the apex, x
// away from the tricuspid ring.
RigidMotion byLandmarks(std::size_t frame, double ring_z_mm) {
  const Vec3d mitral = meanOf(patientMesh("mitral_valve", frame).points),
              tricuspid = meanOf(patientMesh("tricuspid_valve", frame).points);
  Vec3d apex = mitral;
  for (const Vec3d p : patientMesh("lv_endo_closed", frame).points)
    if (length(p - mitral) > length(apex - mitral)) apex = p;
  const Vec3d z = normalised(apex - mitral), aside = mitral - tricuspid;
  const Vec3d x = normalised(aside - dot(aside, z) * z);
  RigidMotion motion{{x, cross(z, x), z}, {}};
  motion.shift = Vec3d{0, 0, ring_z_mm} - motion.turned(mitral);
  return motion;
}

// The heart's cavity at a frame's phase, mm.
Mesh heartMeshAt(const char* part, std::size_t frame) {
  const auto parts = patientsHeart().at(static_cast<double>(frame) / 25);
  const heart::Part& found = partOf(parts, part);
  return Mesh{found.points, found.faces}.scaled(1e3);
}

struct Chamber {
  std::vector<Vec3d> patient;  // points of its surface, in heart coordinates by landmarks
  Mesh heart;
  double rms(const RigidMotion& motion) const {
    double sum = 0;
    for (const Vec3d p : patient) {
      const Vec3d moved = motion.of(p);
      const double apart = length(nearestOn(heart, moved) - moved);
      sum += apart * apart;
    }
    return std::sqrt(sum / static_cast<double>(patient.size()));
  }
};

Chamber chamberAt(const char* patient_name, const char* part, std::size_t frame,
                  const RigidMotion& start) {
  constexpr std::size_t kEvery = 5;  // of the patient's vertices, which are evenly spread
  Chamber chamber{{}, heartMeshAt(part, frame)};
  const Mesh mesh = patientMesh(patient_name, frame);
  for (std::size_t i = 0; i < mesh.points.size(); i += kEvery)
    chamber.patient.push_back(start.of(mesh.points[i]));
  return chamber;
}

// Iterative closest points over both ventricles.
RigidMotion laidOnto(const Chamber& left, const Chamber& right) {
  constexpr int kSteps = 10;
  RigidMotion motion;
  for (int step = 0; step < kSteps; ++step) {
    std::vector<Vec3d> from, to;
    for (const Chamber* chamber : {&left, &right})
      for (const Vec3d p : chamber->patient) {
        from.push_back(p);
        to.push_back(nearestOn(chamber->heart, motion.of(p)));
      }
    motion = rigidFit(from, to);
  }
  return motion;
}

void expectSurfacesNear(std::size_t frame, double ring_z_mm) {
  const RigidMotion start = byLandmarks(frame, ring_z_mm);
  const Chamber left = chamberAt("lv_endo_closed", "lv_cavity", frame, start),
                right = chamberAt("rv_endo_closed", "rv_cavity", frame, start);
  const RigidMotion motion = laidOnto(left, right);
  const double left_mm = left.rms(motion), right_mm = right.rms(motion);
  std::printf("frame %zu: RMS distance left %.2f mm, right %.2f mm\n", frame, left_mm, right_mm);
  EXPECT_LT(left_mm, 5);
  EXPECT_LT(right_mm, 8);
  // Laying on turned the patient but little: the landmarks agree.
  const double cosine = 0.5 * (motion.rows[0].x + motion.rows[1].y + motion.rows[2].z - 1);
  EXPECT_GT(cosine, std::cos(25 * std::numbers::pi / 180));
}

TEST_F(HeartPatientLaw, SurfacesAreNearThePatientsAtEndDiastole) {
  expectSurfacesNear(0, 0);
}

TEST_F(HeartPatientLaw, SurfacesAreNearThePatientsAtEndSystole) {
  expectSurfacesNear(kEndSystole, 14.3);
}

TEST_F(HeartPatientLaw, LeftVolumesFollowThePatients) {
  heart::LeftVentricle left(patientsHeart().parameters());
  const heart::SphereMesh sphere = heart::geodesicSphere(heart::LeftVentricle::kFrequency);
  double worst = 0;
  for (std::size_t k = 0; k < kLeft_ml.size(); ++k) {
    left.contract(patientsHeart().cycle().at(static_cast<double>(k) / 25).left);
    const auto point = [&left](Vec3d d) { return left.cavityPoint(d); };
    const double ml = 1e6 * fluxVolume({heart::pointsOn(sphere, point), sphere.faces});
    EXPECT_NEAR(ml, kLeft_ml[k], 0.08 * kLeft_ml[0]) << k;
    worst = std::max(worst, std::abs(ml - kLeft_ml[k]));
  }
  std::printf("largest difference of volume: %.1f %% of EDV\n", 100 * worst / kLeft_ml[0]);
}

}  // namespace
}  // namespace echocine
