// Chordae: strands between papillary muscles and mitral leaflets, in the picture alone; and the
// echoes of thin strands.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "frame/simulator.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/chordae.h"
#include "scene/elevation_slices.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "speckle/sheet_points.h"
#include "support/all_cases.h"
#include "support/bind_to_surface.h"
#include "support/picture_only.h"
#include "support/plain_scene.h"
#include "support/random_dials.h"
#include "trace/strand_echoes.h"

namespace echocine::chordae_law {
namespace {

constexpr double kDiameter_m = 0.8e-3;

Scene heartWith(const std::map<std::string, double>& dials, double chordae_m = kDiameter_m) {
  Scene scene = heart::heartScene(heart::parametersFrom(dials), heart::View::a4c, 8);
  scene.leaflets.chordae_m = chordae_m;
  return scene;
}

double lengthOf(std::span<const Vec3f> points_m) {
  double sum_m = 0;
  for (std::size_t i = 0; i + 1 < points_m.size(); ++i)
    sum_m += length(toDouble(points_m[i + 1] - points_m[i]));
  return sum_m;
}

// Laws: a chord ends in its vertices; it is never longer than at rest; it is straight where its
// ends are farthest apart and while the valve is closed; it moves without jumps.
void expectSound(const Scene& scene) {
  constexpr int kPhases = 64;
  const MeshMotion motion(scene);
  const Chordae chordae(scene, motion);
  const std::vector<Chordae::Chord>& chords = chordae.chords();
  ASSERT_GT(chords.size(), 4u);
  EXPECT_LE(chords.size(), 20u);
  SurfaceFrame frame;
  std::vector<Vec3f> points_m, before_m;
  double furthest = 0;
  std::map<double, double> slack;  // of all chords, by the distance of the insertions
  for (int i = 0; i < kPhases; ++i) {
    motion.frameAt(static_cast<double>(i) / kPhases, frame, false);
    chordae.at(frame, points_m);
    ASSERT_EQ(points_m.size(), chords.size() * Chordae::kPoints);
    double slack_m = 0, apart_all_m = 0;
    for (const Chordae::Chord& a : chords)
      for (const Chordae::Chord& b : chords)
        apart_all_m += std::pow(length(toDouble(frame.positions_m[index(a.leaflet)][a.insertion] -
                                                frame.positions_m[index(b.leaflet)][b.insertion])),
                                2);
    for (std::size_t c = 0; c < chords.size(); ++c) {
      const std::span<const Vec3f> chord_m =
          std::span(points_m).subspan(c * Chordae::kPoints, Chordae::kPoints);
      const Vec3f from_m = frame.positions_m[index(chords[c].muscle)][chords[c].origin];
      const Vec3f to_m = frame.positions_m[index(chords[c].leaflet)][chords[c].insertion];
      ASSERT_LT(length(chord_m.front() - from_m), 1e-7f);
      ASSERT_LT(length(chord_m.back() - to_m), 1e-7f);
      const double apart_m = length(toDouble(to_m - from_m)), long_m = lengthOf(chord_m);
      // Between the 16 instants that determine the length, ends may be a little farther apart.
      ASSERT_LT(apart_m, 1.03 * chords[c].length_m + 1e-4);
      ASSERT_LT(long_m, 1.03 * chords[c].length_m + 1e-4);
      if (apart_m >= chords[c].length_m) {
        ASSERT_NEAR(long_m, apart_m, 1e-6);
      }
      slack_m += long_m - apart_m;
      furthest = std::max(furthest, apart_m / chords[c].length_m);
      ASSERT_LT(chords[c].length_m, 80.1e-3);
    }
    // No point moves farther than the ends of its chord and the largest sag: no sag changes sides.
    for (std::size_t p = 0; p < before_m.size(); ++p) {
      const std::size_t first = p - p % Chordae::kPoints, last = first + Chordae::kPoints - 1;
      const float ends_m = std::max(length(points_m[first] - before_m[first]),
                                    length(points_m[last] - before_m[last]));
      const float apart_m = length(points_m[last] - points_m[first]);
      ASSERT_LT(length(points_m[p] - before_m[p]), ends_m + 0.16f * apart_m);
    }
    before_m = points_m;
    slack[apart_all_m] = slack_m;
  }
  EXPECT_GT(furthest, 0.999);
  // The sum of squares of all distances is least with the valve closed.
  EXPECT_LT(slack.begin()->second, 1e-4);
}

TEST(ChordaeLaw, FollowMusclesAndLeaflets) {
  expectSound(heartWith({}));
  expectSound(heartWith({{"edv", 70}, {"body-scale", 0.8}}));
  expectSound(heartWith({{"edv", 220}, {"ef", 0.2}, {"mitral-opening", 0.2}}));
}

// Dials of any heart. Those without a shape are rejected elsewhere.
TEST(ChordaeLaw, FollowMusclesAndLeafletsOfRandomHearts) {
  support::checkRandomHearts(
      support::allCases() ? 1000 : 6,
      [](const std::map<std::string, double>& dials) { expectSound(heartWith(dials)); });
}

// Both muscles hold both leaflets. Chords are longer than in human hearts (12.8 +- 4.0 mm, Kavitha
// et al., 2014), because the muscles' tips lie nearer to the apex.
TEST(ChordaeLaw, BothMusclesHoldBothLeaflets) {
  const Scene scene = heartWith({});
  const MeshMotion motion(scene);
  std::map<std::pair<SurfaceId, SurfaceId>, int> pairs;
  double sum_m = 0;
  const Chordae chordae(scene, motion);
  for (const Chordae::Chord& chord : chordae.chords()) {
    ++pairs[{chord.muscle, chord.leaflet}];
    sum_m += chord.length_m;
  }
  EXPECT_EQ(pairs.size(), 4u);
  const double mean_m = sum_m / static_cast<double>(chordae.chords().size());
  std::printf("  mean length %.1f mm\n", 1e3 * mean_m);
  EXPECT_GT(mean_m, 9e-3);
  EXPECT_LT(mean_m, 45e-3);
}

TEST(ChordaeLaw, ScatterersStayInTheirStrand) {
  Scene scene = heartWith({});
  scene.speckle.on = true;
  const MeshMotion motion(scene);
  const auto chordae = std::make_shared<const Chordae>(scene, motion);
  const SheetPoints without(scene, motion, 0), with(scene, motion, 0, {.chordae = chordae});
  ASSERT_GT(with.count(), without.count() + 20 * chordae->chords().size());
  SurfaceFrame frame;
  motion.frameAt(0.4, frame, false);
  std::vector<Vec3f> places_m, others_m, points_m;
  with.at(frame, places_m);
  without.at(frame, others_m);
  ASSERT_EQ(places_m.size(), with.count());
  EXPECT_TRUE(std::equal(others_m.begin(), others_m.end(), places_m.begin()));
  chordae->at(frame, points_m);
  for (std::size_t p = without.count(); p < places_m.size(); ++p) {
    double nearest_m = 1;
    for (std::size_t c = 0; c < chordae->chords().size(); ++c)
      for (std::size_t i = c * Chordae::kPoints; i + 1 < (c + 1) * Chordae::kPoints; ++i)
        nearest_m =
            std::min(nearest_m, distanceToSegment(places_m[p], points_m[i], points_m[i + 1]));
    ASSERT_LT(nearest_m, 0.501 * kDiameter_m);
  }
}

TEST(ChordaeLaw, ChangeThePictureAndNoTruth) {
  support::expectPictureOnly(heartWith({}, 0), heartWith({}));
}

TEST(ChordaeLaw, AreOfLooksButThePaperAndNeedBothEnds) {
  Scene scene = heartWith({}, 0);
  EXPECT_FALSE(planEffects(scene).chordae);
  scene.leaflets.chordae_m = kDiameter_m;
  EXPECT_TRUE(planEffects(scene).chordae);
  scene.accuracy.rays_per_beam = 8;
  EXPECT_FALSE(planEffects(scene).chordae);
  scene = heartWith({});
  std::erase_if(scene.structures,
                [](const Structure& s) { return roleOf(s) == Role::papillary_muscle; });
  EXPECT_FALSE(planEffects(scene).chordae);
  support::expectOfLooksButPaper(&LeafletSettings::chordae_m);
}

// A medium that fills the sector, with a strand in it.
class StrandLaw : public ::testing::Test {
 protected:
  static constexpr double kBlood = 1e-3, kStrand = 0.1, kSpread_m = 0.08;  // eta_b: 1/(m sr)

  StrandLaw() {
    scene.media = {support::medium("blood", 1000, 1540, kAlpha_np_m, kBlood),
                   support::medium("valve", 1000, 1540, 0, kStrand)};
    scene.unit_volume_m3 = 1e-6;
    scene.probe.lines = 128;
    scene.probe.samples = 640;
  }

  // The sum of what the strand adds over all cells, times their area, without its losses: m^2.
  double added(const std::vector<Vec3f>& points_m, double attenuation_np_m = 0,
               double backscatter = 1) {
    const TraceSettings settings = support::straightSettings(scene);
    IntensityTerms terms;
    terms.attenuation = attenuation_np_m > 0;
    terms.spread_undone_at_m = kSpread_m;
    PolarFrame frame;
    frame.lines = scene.probe.lines;
    frame.samples = scene.probe.samples;
    frame.traces.resize(static_cast<std::size_t>(frame.lines));
    for (LineTrace& line : frame.traces)
      line.segments = {{.begin_depth_m = 0,
                        .end_depth_m = 0.16,
                        .exponent_per_m = 4 * attenuation_np_m,
                        .strength_m2_sr = kBlood * scene.unit_volume_m3,
                        .medium = MediumId{0}}};
    frame.intensities.resize(static_cast<std::size_t>(frame.lines * frame.samples));
    const Strand strand{points_m, MediumId{1}, backscatter};
    addStrands(std::span(&strand, 1), kDiameter_m, scene.probe, settings, terms, frame);
    double sum = 0;
    for (int i = 0; i < frame.lines; ++i)
      for (int k = 0; k < frame.samples; ++k) {
        const double path_m = scene.probe.min_depth_m + (k + 0.5) * scene.probe.sampleSpacing();
        sum += static_cast<double>(
                   frame.intensities[static_cast<std::size_t>(i * frame.samples + k)]) *
               lineSpacing(scene.probe, path_m) * scene.probe.sampleSpacing();
      }
    return sum * kSpread_m * kSpread_m / ((kStrand - kBlood) * scene.unit_volume_m3);
  }

  static constexpr double kAlpha_np_m = 0;
  const double kAlong = intensityFromDecibels(-kStrandAnisotropy_db);
  static constexpr double kSection_m2 = std::numbers::pi / 4 * kDiameter_m * kDiameter_m;
  Scene scene = support::plainScene({});
};

// Law: across the imaging plane the beam weighs by a density, so a long strand through the plane
// adds its section, at any place.
TEST_F(StrandLaw, AStrandThroughThePlaneAddsItsSection) {
  for (const Vec3f at : {Vec3f{0, 0, 0.06f}, Vec3f{0.021f, 0, 0.0801f}, Vec3f{-0.03f, 0, 0.1f}})
    EXPECT_NEAR(added({at - Vec3f{0, 0.03f, 0}, at, at + Vec3f{0, 0.03f, 0}}) / kSection_m2, 1,
                2e-3);
}

// Law: beside the plane a strand along a line adds its section times the integral of the beam's
// profile over its length, less the loss along its fibres.
TEST_F(StrandLaw, AStrandBesideThePlaneFadesAsTheBeam) {
  const ElevationBell bell(scene.probe);
  for (const double y_m : {0.0, 1e-3, 2.5e-3}) {
    const double from_m = 0.05, to_m = 0.09;
    double expected_m2 = 0;
    constexpr int kSteps = 4000;
    for (int i = 0; i < kSteps; ++i) {
      const double s = bell.deviation(from_m + (i + 0.5) / kSteps * (to_m - from_m));
      expected_m2 += kAlong * kSection_m2 * (to_m - from_m) / kSteps *
                     std::exp(-0.5 * y_m * y_m / (s * s)) / (s * std::sqrt(2 * std::numbers::pi));
    }
    const auto y = static_cast<float>(y_m);
    EXPECT_NEAR(added({{0.001f, y, 0.05f}, {0.001f, y, 0.09f}}) / expected_m2, 1, 5e-3) << y_m;
  }
}

// Law: a strand that leaves the beam adds the same echo in 64 stretches as in one, although most of
// the 64 lie outside the beam.
TEST_F(StrandLaw, AStrandAddsTheSameInManyStretches) {
  constexpr int kStretches = 64;
  for (const float z_m : {0.02f, 0.08f, 0.15f}) {
    const Vec3f from_m{-0.004f, -0.001f, 0.09f}, to_m{0.004f, 0.03f, z_m};
    std::vector<Vec3f> many_m;
    for (int i = 0; i <= kStretches; ++i)
      many_m.push_back(from_m + static_cast<float>(i) / kStretches * (to_m - from_m));
    EXPECT_NEAR(added(many_m) / added({from_m, to_m}), 1, 2e-3) << z_m;
  }
}

// Law: a strand at one depth has the losses of that depth.
TEST_F(StrandLaw, AStrandIsAttenuatedAsTheLine) {
  const std::vector<Vec3f> across{{0.01f, -0.03f, 0.08f}, {0.01f, 0.03f, 0.08f}};
  const double path_m = std::hypot(0.01, 0.08);
  EXPECT_NEAR(added(across, 5) / added(across), std::exp(-4 * 5 * path_m), 2e-3);
}

// Law: a strand adds in proportion to the excess of its backscatter.
TEST_F(StrandLaw, AStrandAddsTheExcessOfItsBackscatter) {
  const std::vector<Vec3f> across{{0.01f, -0.03f, 0.08f}, {0.01f, 0.03f, 0.08f}};
  EXPECT_NEAR(added(across, 0, 40) / added(across), (40 * kStrand - kBlood) / (kStrand - kBlood),
              1e-3);
  EXPECT_EQ(added(across, 0, kBlood / kStrand), 0);
}

// Law: what scatters no more than its surroundings adds nothing, and neither does a strand outside
// the sector or one beyond the beam.
TEST_F(StrandLaw, NothingIsAddedWithoutContrast) {
  EXPECT_EQ(added({{0, 0.02f, 0.05f}, {0, 0.02f, 0.09f}}), 0);
  EXPECT_EQ(added({{0.2f, 0, 0.05f}, {0.2f, 0, 0.09f}}), 0);
  scene.media[1].backscatter_per_m_sr = kBlood;
  EXPECT_EQ(added({{0, 0, 0.05f}, {0, 0, 0.09f}}), 0);
}

}  // namespace
}  // namespace echocine::chordae_law
