// Volumes of the parametric heart, measured on its files: what is dialled is what is enclosed, and
// muscle and blood are neither made nor lost.

#include <gtest/gtest.h>

#include "support/recorded_heart.h"

namespace echocine {
namespace {

using namespace support;

struct CavityVolumes {
  double at_rest_ml, emptied_ml;  // at end-diastole and end-systole
  double stroke() const { return at_rest_ml - emptied_ml; }
};

// End-diastole and end-systole of a heart, as files would have them.
struct Extremes {
  std::vector<heart::Part> at_rest, emptied;
  explicit Extremes(const heart::ParametricHeart& model)
      : at_rest(model.at(0)), emptied(model.at(model.cycle().events().aortic_closes)) {}
};

Mesh writtenMesh(const std::vector<heart::Part>& parts, const char* name) {
  const heart::Part& part = partOf(parts, name);
  return meshOfObj(
      heartMesh({part.kind,
                 part.faces,
                 {},
                 heart::LoopFit(part.points.size(), part.faces).controlPoints({&part.points, 1}),
                 {}},
                0));
}

CavityVolumes volumesOf(const Extremes& heart, const char* part, bool subdivide) {
  const auto of = [&](const Mesh& mesh) {
    return millilitresOf(subdivide ? subdivided(mesh) : mesh);
  };
  return {of(writtenMesh(heart.at_rest, part)), of(writtenMesh(heart.emptied, part))};
}

// How far the points at the valve's plane, and the hinges of its leaflets, come down in systole,
// mm.
double planeDescent(const Extremes& heart) {
  const Mesh before = writtenMesh(heart.at_rest, "lv_cavity"),
             after = writtenMesh(heart.emptied, "lv_cavity");
  double descent = 0;
  int count = 0;
  for (std::size_t i = 0; i < before.points.size(); ++i)
    if (std::abs(before.points[i].z) < 2.5) {
      descent += after.points[i].z - before.points[i].z;
      ++count;
    }
  return descent / count;
}
double hingeDescent(const Extremes& heart) {
  const auto hinge_z = [](const std::vector<heart::Part>& parts) {
    double sum = 0;
    for (const char* name : {"mitral_anterior", "mitral_posterior"}) {
      const Mesh mesh = writtenMesh(parts, name);
      for (std::size_t i = 0; i < heart::kLeafletColumns; ++i) sum += mesh.points[i].z;
    }
    return sum / (2 * heart::kLeafletColumns);
  };
  return hinge_z(heart.emptied) - hinge_z(heart.at_rest);
}

void expectDialled(const heart::Parameters& dials) {
  const Extremes heart{heart::ParametricHeart(dials)};
  for (const bool subdivide : {false, true}) {
    const CavityVolumes left = volumesOf(heart, "lv_cavity", subdivide),
                        right = volumesOf(heart, "rv_cavity", subdivide);
    EXPECT_NEAR(left.at_rest_ml, dials.edv_ml, 0.01 * dials.edv_ml);
    EXPECT_NEAR(left.stroke() / left.at_rest_ml, dials.ejection_fraction, 0.01);
    EXPECT_NEAR(right.at_rest_ml, dials.rv_edv_ml, 0.015 * dials.rv_edv_ml);
    EXPECT_NEAR(right.stroke(), left.stroke(), 0.01 * left.stroke());
    const CavityVolumes outer = volumesOf(heart, "lv_wall", subdivide);
    const double wall_ml = outer.at_rest_ml - left.at_rest_ml;
    EXPECT_NEAR(outer.emptied_ml - left.emptied_ml, wall_ml, 0.05 * wall_ml);
    EXPECT_GT(wall_ml, 30 * std::pow(dials.edv_ml / 120, 2.0 / 3));  // a wall there must be
  }
  EXPECT_NEAR(planeDescent(heart), dials.mapse_mm, 1.0);
  EXPECT_NEAR(hingeDescent(heart), dials.mapse_mm, 1.0);
}

class HeartVolumeLaw : public testing::TestWithParam<double> {};

// Measured on the written meshes after subdivision, as a user's own tools would; not on the shapes
// they came from.
TEST_P(HeartVolumeLaw, DialsAreWhatTheFilesEnclose) {
  for (const double ef : {0.25, 0.40, 0.55, 0.70}) {
    SCOPED_TRACE(testing::Message() << "edv " << GetParam() << " ef " << ef);
    expectDialled(heart::parametersFrom({{"edv", GetParam()}, {"ef", ef}}));
  }
}

INSTANTIATE_TEST_SUITE_P(EndDiastolic_mL, HeartVolumeLaw, testing::Values(80, 120, 200));

// Also of the shapes at the limits of what a population has.
TEST(HeartVolumes, DialsAreWhatTheFilesEncloseInOtherShapes) {
  for (const Dials& shape : {Dials{{"conicity", 0.55}, {"apical-motion", 1.3}, {"ef", 0.4}},
                             Dials{{"conicity", 0.93}, {"apical-motion", 0.75}, {"ef", 0.65}},
                             Dials{{"bow-lateral", 0.04},
                                   {"bow-anterior", -0.03},
                                   {"ellipticity", 0.2},
                                   {"ellipticity-45", -0.1},
                                   {"apical-thickness", 0.8},
                                   {"lateral-thickness", 1.25},
                                   {"anterior-thickness", 0.85}}})
    expectDialled(heart::parametersFrom(shape));
}

// Ventricles, wall and atria at every keyframe: the record's numbers are those of its meshes, the
// wall keeps its volume all the way, and a beat's blood goes through every chamber.
TEST(HeartVolumes, HoldAtEveryKeyframeOfTheDefaultHeart) {
  const heart::Recording& recording = recordedHeart({}, 6).recording;
  std::map<std::string, std::vector<double>> ml;
  for (const char* name : {"lv_cavity", "lv_wall", "rv_cavity", "la", "ra"})
    for (std::size_t k = 0; k < recording.phases.size(); ++k) {
      ml[name].push_back(millilitresOf(subdivided(support::writtenMesh(recording, name, k))));
      EXPECT_NEAR(ml[name][k], 1e6 * recording.part(name).volume_m3[k], 2e-4 * ml[name][k]);
    }
  const double wall_ml = ml["lv_wall"][0] - ml["lv_cavity"][0];
  for (std::size_t k = 0; k < recording.phases.size(); ++k) {
    EXPECT_NEAR(ml["lv_wall"][k] - ml["lv_cavity"][k], wall_ml, 0.05 * wall_ml) << k;
    EXPECT_GE(ml["lv_cavity"][k], ml["lv_cavity"][recording.end_systole] - 1e-3 * 120) << k;
  }
  for (const char* atrium : {"la", "ra"}) {
    const auto [least, most] = std::minmax_element(ml[atrium].begin(), ml[atrium].end());
    const double dialled_ml = std::string(atrium) == "la" ? 55 : 52;
    EXPECT_NEAR(*most, dialled_ml, 0.03 * dialled_ml) << atrium;
    EXPECT_NEAR(*least / *most, 0.45, 0.05) << atrium;  // an atrium empties by 55 %
  }
}

}  // namespace
}  // namespace echocine
