// Global longitudinal strain of a parametric heart without meshes: Eq. 18 of fit_strain.h.

#include "fit/fit_strain.h"

#include <gtest/gtest.h>

#include "motion/heart/heart_cycle.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/interior_motion.h"
#include "truth/frame_truth.h"

namespace echocine::fit {
namespace {

// That of the ground truth, from meshes and material points.
double strainOfMeshes(const heart::Parameters& parameters) {
  Scene scene = heart::heartScene(parameters, heart::View::a4c, 12, Look::paper);
  scene.truth.function = true;
  const MeshMotion motion(scene);
  const MotionField field = interiorMotion(scene, motion);
  const HeartFunction function(scene, motion, field, 0);
  SurfaceFrame surfaces;
  FieldFrame frame;
  const double end_systole = scene.motion.end_systole_phase.value();
  motion.frameAt(end_systole, surfaces);
  field.at(end_systole, frame);
  return function.at(surfaces, frame).global_longitudinal_strain;
}

TEST(FitStrain, IsCloseToTheGroundTruthOfMeshes) {
  for (const auto& dials :
       {std::map<std::string, double>{}, {{"ef", 0.35}, {"edv", 180}, {"mapse", 7}}}) {
    const heart::Parameters parameters = heart::parametersFrom(dials);
    const double strain = longitudinalStrainOf(parameters), truth = strainOfMeshes(parameters);
    EXPECT_NEAR(strain, truth, 0.015);
    EXPECT_LT(strain, -0.05);
  }
}

// 0 at end-diastole, most negative near end-systole, and more negative with more excursion.
TEST(FitStrain, FollowsTheBeat) {
  const heart::Parameters parameters = heart::parametersFrom({{"ef", 0.6}});
  const double end = heart::Cycle(parameters).events().aortic_closes;
  const std::vector<double> strains = longitudinalStrains(parameters, {0, 0.5 * end, end});
  EXPECT_EQ(strains[0], 0);
  EXPECT_LT(strains[1], 0);
  EXPECT_LT(strains[2], strains[1]);
  EXPECT_EQ(strains[2], longitudinalStrainOf(parameters));
  EXPECT_LT(longitudinalStrainOf(heart::parametersFrom({{"ef", 0.6}, {"mapse", 15}})),
            longitudinalStrainOf(heart::parametersFrom({{"ef", 0.6}, {"mapse", 10}})));
}

}  // namespace
}  // namespace echocine::fit
