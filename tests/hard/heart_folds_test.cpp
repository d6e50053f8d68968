// Random hearts over the full ranges of all dials: what is written folds nowhere in the beat, and
// what has no such shape is refused in one line.
//
// ECHOCINE_RANDOM_HEARTS sets how many; each is then looked at 200 times a beat. So are the hearts
// that the published dataset draws from its populations.

#include <gtest/gtest.h>

#include <map>

#include "core/error.h"
#include "dataset/aim.h"
#include "dataset/redraw.h"
#include "motion/heart/heart_scene.h"
#include "motion/mesh/surface_measure.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/motion_warnings.h"
#include "support/paths.h"
#include "support/random_world.h"

namespace echocine {
namespace {

// Between the normals of neighbours: 150 degrees, as findBreaks() has it.
constexpr double kFoldedCosine = -0.8660254;

struct FoldExtent {
  std::uint64_t hearts;
  int keyframes, frames;
};

FoldExtent extent() {
  if (const char* asked = std::getenv("ECHOCINE_RANDOM_HEARTS"))
    return {std::strtoull(asked, nullptr, 10), 12, 200};
#ifdef ECHOCINE_SANITIZED
  return {4, 4, 16};
#else
  return {12, 6, 24};
#endif
}

// Every fourth has all dials given, the others half of them; a third have segments of their own,
// and a third a shape of their own.
heart::Parameters randomHeart(std::uint64_t number) {
  support::Dice dice(number), shape(number + 1000000);
  std::map<std::string, double> given;
  for (const heart::Dial& dial : heart::dials()) {
    if (heart::isShapeDial(dial.key)) {
      if (number % 3 == 1) given[dial.key] = shape.number(dial.low, dial.high);
      continue;
    }
    const bool is_given = dice.chance(number % 4 == 3 ? 1.0 : 0.5);
    const double value = dice.number(dial.low, dial.high);
    if (is_given) given[dial.key] = value;
  }
  heart::Parameters parameters = heart::parametersFrom(given);
  if (dice.chance(1.0 / 3))
    for (heart::Segment& segment : parameters.segments)
      if (dice.chance(0.4)) {
        segment.amplitude = dice.number(-0.5, 1.5);
        segment.delay_s = std::max(0.0, dice.number(-0.2, 0.2));
      }
  parameters.volumes_rule = dice.chance(0.3);
  return parameters;
}

// Pairs of triangles with a common edge.
std::vector<std::array<std::size_t, 2>> hingesOf(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> sides;
  std::vector<std::array<std::size_t, 2>> hinges;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t u = triangles[t][k], v = triangles[t][(k + 1) % 3];
      if (const auto other = sides.find({v, u}); other != sides.end())
        hinges.push_back({t, other->second});
      else
        sides[{u, v}] = t;
    }
  return hinges;
}

// What no frame of a beat may show.
void expectNoFold(Scene scene, const FoldExtent& wanted) {
  scene.acquisition.frame_rate_hz = wanted.frames * scene.acquisition.heart_rate_hz;
  const MeshMotion motion(scene);
  // Surfaces of extreme hearts may lose or gain more than 1 % of a stroke between two keyframes:
  // the sac with 6 keyframes; with more, a right atrium or right wall (2 of 500 random hearts).
  for (const std::string& warning : motionWarnings(scene, motion))
    EXPECT_NE(warning.find(" both adjacent keyframes"), std::string::npos) << warning;
  std::vector<std::vector<std::array<std::size_t, 2>>> hinges;
  for (const SurfaceTopology& surface : motion.surfaces())
    hinges.push_back(hingesOf(surface.triangles));
  SurfaceFrame frame;
  for (int i = 0; i < wanted.frames; ++i) {
    motion.frameAt(static_cast<double>(i) / wanted.frames, frame, false);
    for (const SurfaceTopology& surface : motion.surfaces()) {
      if (surface.membrane || (surface.still && i > 0)) continue;
      const std::vector<Vec3f>& points = frame.positions_m[index(surface.id)];
      std::vector<Vec3d> normals;
      for (const Triangle& t : surface.triangles) {
        const Vec3d area = doubleArea(t, points);
        normals.push_back((1 / length(area)) * area);
      }
      const std::string& name = scene.structures[index(surface.id)].name;
      for (const auto& [a, b] : hinges[index(surface.id)])
        ASSERT_GT(dot(normals[a], normals[b]), kFoldedCosine)
            << name << ", frame " << i << ", face " << a;
      ASSERT_GT(enclosedVolume(surface, points), 0) << name << ", frame " << i;
    }
  }
}

Scene sceneOf(const heart::Parameters& parameters, const FoldExtent& wanted) {
  return heart::heartScene(parameters, heart::View::a4c, wanted.keyframes);
}

void expectNoFold(const heart::Parameters& parameters, const FoldExtent& wanted) {
  expectNoFold(sceneOf(parameters, wanted), wanted);
}

void expectANamedKey(const std::string& refusal) {
  EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
  const std::string key = refusal.substr(0, refusal.find(':'));
  bool known = key == "segment" || key == "segments" || key == "heart";
  for (const heart::Dial& dial : heart::dials()) known |= key == dial.key;
  EXPECT_TRUE(known) << refusal;
}

TEST(HeartFolds, NoRandomHeartFoldsAnywhereInItsBeat) {
  const FoldExtent wanted = extent();
  std::uint64_t sound = 0;
  for (std::uint64_t number = 0; number < wanted.hearts; ++number) {
    SCOPED_TRACE("random heart " + std::to_string(number));
    try {
      expectNoFold(randomHeart(number), wanted);
      ++sound;
    } catch (const SceneError& refusal) {
      expectANamedKey(refusal.what());
    }
  }
  std::printf("%llu of %llu random hearts have a shape\n", static_cast<unsigned long long>(sound),
              static_cast<unsigned long long>(wanted.hearts));
  EXPECT_GE(3 * sound, wanted.hearts);  // refusing them all would be easy
}

// Draws without a valid heart are drawn again, as a dataset does: also those whose keyframes fold.
TEST(HeartFolds, NoHeartOfThePublishedDatasetFolds) {
  const dataset::Spec spec = dataset::readSpec(std::filesystem::path(support::kSourceDir) /
                                               "examples/datasets/echocine_tte_1000.toml");
  FoldExtent wanted = extent();
  if (std::getenv("ECHOCINE_RANDOM_HEARTS") == nullptr)
    wanted.hearts /= 4;               // the other test has more
  std::map<std::string, int> hearts;  // by population
  std::vector<std::string> impossible;
  for (std::uint64_t n = 0; n < wanted.hearts; ++n) {
    SCOPED_TRACE("heart " + std::to_string(n + 1));
    Scene scene = dataset::firstPossible(
        spec, static_cast<int>(n),
        [&](const dataset::Draw& draw) {
          Scene made = sceneOf(dataset::modelOf(spec, draw.values).parameters(), wanted);
          ++hearts[draw.population->name];
          return made;
        },
        impossible);
    expectNoFold(std::move(scene), wanted);
  }
  std::string counts;
  for (const auto& [name, count] : hearts) counts += fmt::format(", {} {}", name, count);
  std::printf("%llu drawn hearts%s; %zu impossible draws\n",
              static_cast<unsigned long long>(wanted.hearts), counts.c_str(), impossible.size());
  EXPECT_LE(4 * impossible.size(), wanted.hearts);
}

// The right atrium is dented by the aorta, the left ventricle and the left atrium at once.
TEST(HeartFolds, ARightAtriumAmongLargeNeighboursIsSound) {
  const auto dials = heart::parametersFrom(
      {{"ef", 0.69}, {"edv", 178}, {"hr", 60}, {"wall-thickness", 13}, {"twist", 12}});
  expectNoFold(dials, {1, 12, 200});
}

// A face of its left atrium looks elsewhere for a hundredth of the beat only.
TEST(HeartFolds, AFaceThatTurnsForAnInstantIsSound) {
  expectNoFold(randomHeart(543), {1, 12, 200});
}

}  // namespace
}  // namespace echocine
