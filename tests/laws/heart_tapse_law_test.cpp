// Excursion of the tricuspid ring's lateral end (TAPSE), measured as in M-mode: along the line from
// the apical probe to that end at end-diastole.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "motion/heart/heart_scene.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/scene_reader.h"
#include "support/paths.h"

namespace echocine {
namespace {

// TAPSE is 17 mm or more in health (Lang et al., J. Am. Soc. Echocardiogr. 28, 1-39, 2015), and its
// means are 24.0 mm in men and 23.2 mm in women (Ferrara et al., Int. J. Cardiol. 223, 736, 2016).
constexpr double kLeastTapse_mm = 17, kMostTapse_mm = 25;
constexpr double kLeastMapse_mm = 12, kMostMapse_mm = 15;  // healthy

// The beat of a heart in the probe's frame, whose apex is the origin; the view is in y = 0.
class Beat4c {
 public:
  explicit Beat4c(const Scene& scene) : scene_(scene), motion_(scene), frames_(kFrames) {
    for (int i = 0; i < kFrames; ++i)
      motion_.frameAt(static_cast<double>(i) / kFrames, frames_[static_cast<std::size_t>(i)],
                      false);
  }

  const std::vector<Vec3f>& pointsOf(const char* name, std::size_t frame = 0) const {
    for (std::size_t s = 0; s < scene_.structures.size(); ++s)
      if (scene_.structures[s].name == name) return frames_[frame].positions_m[s];
    throw std::runtime_error("no structure " + std::string(name));
  }

  // The hinge of a leaflet: its vertex in the view that is farthest from `from`.
  std::size_t hingeOf(const char* leaflet, Vec3d from) const {
    const std::vector<Vec3f>& p = pointsOf(leaflet);
    constexpr float kInView_m = 3e-3f;
    std::size_t best = 0;
    double farthest_m = 0;
    for (std::size_t v = 0; v < p.size(); ++v)
      if (const double m = length(toDouble(p[v]) - from);
          std::abs(p[v].y) < kInView_m && m > farthest_m) {
        farthest_m = m;
        best = v;
      }
    EXPECT_GT(farthest_m, 0) << leaflet;
    return best;
  }

  std::size_t nearest(const char* name, Vec3d to) const {
    const std::vector<Vec3f>& p = pointsOf(name);
    const auto found = std::min_element(p.begin(), p.end(), [&](Vec3f a, Vec3f b) {
      return length(toDouble(a) - to) < length(toDouble(b) - to);
    });
    return static_cast<std::size_t>(found - p.begin());
  }

  // Largest motion of a vertex towards the probe along the line to its first place, mm.
  double excursion_mm(const char* name, std::size_t vertex) const {
    const Vec3d first = toDouble(pointsOf(name)[vertex]), line = normalised(first);
    double most_m = 0;
    for (std::size_t f = 0; f < frames_.size(); ++f)
      most_m = std::max(most_m, dot(first - toDouble(pointsOf(name, f)[vertex]), line));
    return 1e3 * most_m;
  }

 private:
  static constexpr int kFrames = 50;
  const Scene& scene_;
  MeshMotion motion_;
  std::vector<SurfaceFrame> frames_;
};

struct Excursions {
  double leaflet_mm = 0, wall_mm = 0;  // at the lateral tricuspid hinge
  double septal_mm = 0, mitral_mm = 0;
};

Excursions excursionsOf(const Scene& scene) {
  const Beat4c beat(scene);
  const auto middle = [&](const char* name) {
    Vec3d sum{};
    for (const Vec3f p : beat.pointsOf(name)) sum = sum + toDouble(p);
    return (1.0 / static_cast<double>(beat.pointsOf(name).size())) * sum;
  };
  const Vec3d left = middle("mitral_posterior"), right = middle("tricuspid_anterior");
  const std::size_t lateral = beat.hingeOf("tricuspid_anterior", left),
                    septal = beat.hingeOf("tricuspid_septal", right),
                    mitral = beat.hingeOf("mitral_posterior", right);
  const Vec3d at = toDouble(beat.pointsOf("tricuspid_anterior")[lateral]);
  return {beat.excursion_mm("tricuspid_anterior", lateral),
          beat.excursion_mm("rv_cavity", beat.nearest("rv_cavity", at)),
          beat.excursion_mm("tricuspid_septal", septal),
          beat.excursion_mm("mitral_posterior", mitral)};
}

Excursions dialledExcursions(const std::map<std::string, double>& dials) {
  return excursionsOf(
      heart::heartScene(heart::parametersFrom(dials), heart::View::a4c, 12, Look::paper));
}

void expectHealthy(const Excursions& e) {
  testing::Test::RecordProperty("leaflet_mm", std::to_string(e.leaflet_mm));
  testing::Test::RecordProperty("wall_mm", std::to_string(e.wall_mm));
  for (const double tapse_mm : {e.leaflet_mm, e.wall_mm}) {
    EXPECT_GE(tapse_mm, kLeastTapse_mm);
    EXPECT_LE(tapse_mm, kMostTapse_mm);
    EXPECT_GT(tapse_mm, e.septal_mm + 4);  // the ring tilts
  }
  EXPECT_NEAR(e.leaflet_mm, e.wall_mm, 3);  // the leaflet stays at the wall
  EXPECT_GE(e.mitral_mm, kLeastMapse_mm);
  EXPECT_LE(e.mitral_mm, kMostMapse_mm);
}

TEST(HeartTapseLaw, HealthyHeartsHaveAHealthyExcursion) {
  {
    SCOPED_TRACE("shipped");
    expectHealthy(excursionsOf(readScene(std::filesystem::path(support::kSourceDir) /
                                         "examples/beating_heart/scene.toml")));
  }
  SCOPED_TRACE("default");
  expectHealthy(dialledExcursions({}));
}

// The descent follows the dialled excursion of the base, which follows the ejection fraction.
TEST(HeartTapseLaw, ItFallsWithTheEjectionFraction) {
  double last_mm = std::numeric_limits<double>::infinity();
  for (const double ef : {0.60, 0.45, 0.30}) {
    SCOPED_TRACE(ef);
    const Excursions e = dialledExcursions({{"ef", ef}});
    EXPECT_LT(e.wall_mm, last_mm - 4);
    EXPECT_GT(e.wall_mm, 20 * ef);
    EXPECT_LT(e.wall_mm, 42 * ef);
    last_mm = e.wall_mm;
  }
  EXPECT_LT(last_mm, kLeastTapse_mm);  // a failing heart is seen to fail
}

TEST(HeartTapseLaw, ABaseThatStaysHasNone) {
  const Excursions e = dialledExcursions({{"mapse", 0.0}, {"ef", 0.5}});
  EXPECT_LT(e.mitral_mm, 2);
  EXPECT_LT(e.wall_mm, 8);  // the wall still moves inwards
}

}  // namespace
}  // namespace echocine
