// tilt_table [first|second|patient|another]: planes that were tilted and rotated by known angles,
// and what the search finds of them. The models are the same hearts, with another speckle and look;
// at last another person's heart.

#include <fmt/format.h>

#include <array>
#include <cstring>

#include "core/parallel.h"
#include "core/units.h"
#include "fit/plane_tilt.h"
#include "motion/surfaces/probe_placement.h"
#include "support/view_loops.h"

namespace echocine::bench {
namespace {

using namespace echo;
using namespace fit;
using namespace support;

struct Planted {
  double tilt_deg, rotate_deg;
};
constexpr std::array kPlanted{Planted{0, 0},  Planted{6, 0}, Planted{-6, 0},
                              Planted{3, -5}, Planted{0, 8}, Planted{-8, 4}};
constexpr double kMost_deg = 10;

void tellHeart(const char* name, const Scene& scene, const Scene& models, int seed) {
  const MeshMotion motion(models);
  const TiltableModel model(models, motion, kFitFrames);
  const ModelLoop untilted = model.at({});
  fmt::print("{}\n", name);
  for (const Planted& planted : kPlanted) {
    Scene held = scene;
    held.probe.pose = turnedAndTilted(scene.probe.pose, radiansFromDegrees(planted.rotate_deg),
                                      radiansFromDegrees(planted.tilt_deg));
    SideOptions side;
    side.ed_frame = 0;
    const ModelDiscrepancy d(scannedLoop(held, 24, seed), side, untilted);
    const TiltFound f = searchTilt([&](const PlaneTilt& tilt) { return model.at(tilt); }, d,
                                   d.search(untilted), kMost_deg);
    fmt::print(
        "  tilt {:+.0f}, rotate {:+.0f} deg: found {:+.2f}, {:+.2f}, confidence {:.3f}, {:.3f}; "
        "D {:.4f}, untilted {:.4f}; shift {:.1f}, {:.1f} mm, turn {:.1f} deg; {} planes, {:.1f} "
        "s\n",
        planted.tilt_deg, planted.rotate_deg, degreesFromRadians(f.tilt.tilt_rad),
        degreesFromRadians(f.tilt.rotate_rad), f.tilt_confidence, f.rotate_confidence,
        f.found.discrepancy, f.untilted, 1e3 * f.found.pose.shift_x_m, 1e3 * f.found.pose.shift_z_m,
        degreesFromRadians(f.found.pose.turn_rad), f.planes, 1e-3 * f.cpu_ms);
    std::fflush(stdout);
  }
}

Scene parametric(const std::map<std::string, double>& dials) {
  return heart::heartScene(heart::parametersFrom(dials), View::a4c, 24, Look::scanner);
}

void run(const char* only) {
  const auto wanted = [&](const char* what) {
    return only == nullptr || std::strcmp(only, what) == 0;
  };
  const auto itself = [](const char* name, const Scene& scene, int seed) {
    tellHeart(name, scene, scene, seed);
  };
  if (wanted("first"))
    itself("parametric, EF 0.45, 150 mL",
           parametric({{"ef", 0.45}, {"edv", 150}, {"wall-thickness", 11}, {"hr", 72}}), 3);
  if (wanted("second"))
    itself("parametric, EF 0.36, 190 mL",
           parametric({{"ef", 0.36}, {"edv", 190}, {"wall-thickness", 10}, {"hr", 80}}), 29);
  if (wanted("patient")) itself("a patient's ventricles", sceneOf(Family::patient, View::a4c), 5);
  if (wanted("another"))
    tellHeart("a patient's ventricles, models are the healthy default heart",
              sceneOf(Family::patient, View::a4c), parametric({}), 5);
}

}  // namespace
}  // namespace echocine::bench

int main(int argc, char** argv) {
  echocine::withThreads(0, [&] { echocine::bench::run(argc > 1 ? argv[1] : nullptr); });
}
