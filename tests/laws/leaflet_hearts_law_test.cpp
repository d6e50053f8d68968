// Leaflets with thickness over whole beats, of hearts of any dials: closed bodies without folds.

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "core/error.h"
#include "support/all_cases.h"
#include "support/random_dials.h"
#include "support/thick_leaflets.h"

namespace echocine::leaflet_hearts {
namespace {

using support::allCases, support::Thick, support::thickLeaflets;

// No face of a body looks against its sheet in the whole beat, and every body is closed.
void expectSound(const Scene& scene) {
  const Thick thick(scene);
  int bodies = 0;
  SurfaceFrame sheet;
  for (const SurfaceTopology& body : thick.bodies.surfaces()) {
    const std::size_t s = index(body.id);
    if (!thick.bodies.isBody(body.id)) continue;
    ++bodies;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
    for (const Triangle& t : body.triangles)
      for (std::size_t k = 0; k < 3; ++k) ++runs[{t[k], t[(k + 1) % 3]}];
    for (const auto& [edge, count] : runs) {
      ASSERT_EQ(count, 1);
      ASSERT_TRUE(runs.contains({edge.second, edge.first}));
    }
    const std::vector<Triangle>& flat = thick.motion.surfaces()[s].triangles;
    for (int i = 0; i < 40; ++i) {
      thick.motion.frameAt(i / 40.0, sheet, false);
      const std::vector<Vec3f> body_m = thick.at(i / 40.0).positions_m[s];
      const auto normalOf = [](const Triangle& t, const std::vector<Vec3f>& p) {
        return toDouble(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
      };
      for (std::size_t t = 0; t < flat.size(); ++t) {
        const Vec3d n = normalOf(flat[t], sheet.positions_m[s]);
        ASSERT_GT(dot(normalOf(body.triangles[t], body_m), n), 0) << scene.structures[s].name;
        ASSERT_LT(dot(normalOf(body.triangles[t + flat.size()], body_m), n), 0);
      }
      ASSERT_GT(enclosedVolume(body, body_m), 0);
    }
  }
  // Two leaflets of each inflow valve, three cusps of each outflow valve.
  EXPECT_EQ(bodies, scene.leaflets.cusp_m > 0 ? 10 : 4);
}

TEST(LeafletHearts, OfHeartsAreClosedAndTurnNoFaceOver) {
  expectSound(thickLeaflets({}, 1.5e-3));
  expectSound(thickLeaflets({}, 3e-3));
  expectSound(thickLeaflets({}, 1.5e-3, 0.45e-3));
  expectSound(thickLeaflets({{"edv", 70}, {"body-scale", 0.8}}, 1.5e-3));
  if (!allCases()) return;
  expectSound(thickLeaflets({{"edv", 220}, {"ef", 0.2}, {"mitral-opening", 0.2}}, 1.5e-3));
  expectSound(thickLeaflets({{"hr", 120}, {"mapse", 6}}, 1.5e-3));
}

// Random hearts over the full ranges of all dials; those without a shape are refused by name
// elsewhere.
TEST(LeafletHearts, OfRandomHeartsTurnNoFaceOver) {
  support::checkRandomHearts(allCases() ? 60 : 5, [](const std::map<std::string, double>& dials) {
    expectSound(thickLeaflets(dials, 1.5e-3, 0.45e-3));
  });
}

}  // namespace
}  // namespace echocine::leaflet_hearts
