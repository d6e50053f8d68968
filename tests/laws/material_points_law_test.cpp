// Material points: what moves by one map moves everywhere by it, and elsewhere the field goes with
// the surfaces that can be seen, never turns over and keeps walls in walls.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "core/hash_random.h"
#include "motion/interior/top_surfaces.h"
#include "motion/surfaces/interior_motion.h"
#include "scene/scene_reader.h"
#include "support/bind_to_surface.h"
#include "support/meshes.h"
#include "support/paths.h"
#include "support/patient_scene.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

// Rows of a linear map and a shift, m.
struct AffineMap {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, shift;
  Vec3d operator()(Vec3d p) const { return Vec3d{dot(x, p), dot(y, p), dot(z, p)} + shift; }
};

std::vector<Vec3f> floats(const std::vector<Vec3d>& points, const AffineMap& map) {
  std::vector<Vec3f> moved;
  for (const Vec3d p : points) moved.push_back(toFloat(map(p)));
  return moved;
}

// A ball in a ball at 8 cm depth, both moved by one map half-way through the beat.
std::vector<InteriorSurface> nestedBalls(const AffineMap& map) {
  std::vector<InteriorSurface> surfaces;
  const double phases[] = {0.0, 0.5};
  for (const double radius : {0.04, 0.03}) {
    const support::Mesh ball = support::icosphere(3, radius).moved({0, 0, 0.08});
    surfaces.push_back({"ball",
                        ball.triangles,
                        KeyframeWeights(phases, Interpolation::catmull_rom),
                        {floats(ball.points, {}), floats(ball.points, map)},
                        false,
                        radius < 0.035 ? 2 : 1});
  }
  return surfaces;
}

// What is affine on the surfaces is met exactly inside, at any distance.
TEST(MaterialPointsLaw, OneAffineMapMovesEveryPoint) {
  const AffineMap map{{0.8, 0.1, 0}, {-0.05, 0.9, 0.1}, {0, 0.05, 1.15}, {0.002, -0.004, 0.003}};
  const MotionField field(nestedBalls(map));
  FieldFrame frame;
  field.at(0.5, frame);
  for (std::uint64_t i = 0; i < 3000; ++i) {
    const Vec3d p{0.05 * (2 * uniformFromHash(hashOf(i, 1)) - 1),
                  0.05 * (2 * uniformFromHash(hashOf(i, 2)) - 1),
                  0.08 + 0.05 * (2 * uniformFromHash(hashOf(i, 3)) - 1)};
    if (length(p - Vec3d{0, 0, 0.08}) > 0.039) continue;
    const Vec3d placed = toDouble(frame[field.groupAt(toFloat(p))].place(toFloat(p)));
    EXPECT_LT(length(placed - map(p)), 1e-5 * 0.08) << "point " << i;
  }
}

// Boxes of all sizes, also of none: inside, outside and across both balls' borders.
TEST(MaterialPointsLaw, PlacesTogetherHaveTheGroupsOfEachAlone) {
  const MotionField field(nestedBalls({}));
  for (std::uint64_t box = 0; box < 400; ++box) {
    const auto in = [&](std::uint64_t n, double half_m) {
      return half_m * (2 * uniformFromHash(hashOf(box, n)) - 1);
    };
    const Vec3d middle{in(1, 0.05), in(2, 0.05), 0.08 + in(3, 0.05)};
    const double half_m = box % 20 == 0 ? 0 : 0.02 * uniformFromHash(hashOf(box, 4));
    std::vector<Vec3f> places;
    for (std::uint64_t i = 0; i < 60; ++i)
      places.push_back(toFloat(
          middle + Vec3d{in(3 * i + 5, half_m), in(3 * i + 6, half_m), in(3 * i + 7, half_m)}));
    std::vector<GroupId> together(places.size());
    field.groupsAt(places, together);
    for (std::size_t i = 0; i < places.size(); ++i)
      EXPECT_EQ(together[i], field.groupAt(places[i])) << "box " << box << ", place " << i;
  }
}

TEST(MaterialPointsLaw, FarFromWhatMovesNothingDoes) {
  const MotionField field(nestedBalls({{0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8}, {0, 0, 0.016}}));
  FieldFrame frame;
  field.at(0.5, frame);
  const Vec3f far{0.2f, 0, 0.08f};
  EXPECT_EQ(field.groupAt(far), field.background());
  EXPECT_EQ(frame[field.background()].place(far), far);
}

TEST(MaterialPointsLaw, APlaceIsFoundBackAndASlabIsTheWhole) {
  const MotionField field(
      nestedBalls({{0.9, 0.1, 0}, {0, 0.8, 0}, {0.1, 0, 1.1}, {0.003, 0.002, 0}}));
  FieldFrame frame, slab;
  field.at(0.3, frame);
  field.at(0.3, slab, FieldPart(field.groupCount(), std::pair(-0.005f, 0.005f)));
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Vec3f p = toFloat({0.02 * uniformFromHash(hashOf(i, 1)),
                             0.005 * (2 * uniformFromHash(hashOf(i, 2)) - 1),
                             0.08 + 0.02 * uniformFromHash(hashOf(i, 3))});
    const GroupFrame& group = frame[field.groupAt(p)];
    const Vec3f placed = group.place(p);
    EXPECT_EQ(slab[field.groupAt(p)].place(p), placed);
    const auto back = group.reference(placed, placed);
    ASSERT_TRUE(back);
    EXPECT_LT(length(*back - p), 5e-6f);
  }
}

TEST(MaterialPointsLaw, PointsBoundToASurfaceStayOnIt) {
  const support::Mesh ball = support::icosphere(3, 0.04);
  const std::vector<Vec3f> rest = floats(ball.points, {}),
                           grown = floats(ball.points, {{1.2, 0, 0}, {0, 1.2, 0}, {0, 0, 1.2}, {}});
  std::vector<Vec3f> points;
  for (const Triangle& t : ball.triangles)
    points.push_back(0.2f * rest[t[0]] + 0.3f * rest[t[1]] + 0.5f * rest[t[2]]);
  const auto bound = bindToSurface(SurfaceId{0}, ball.triangles, rest, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LT(length(place(bound[i], ball.triangles, rest) - points[i]), 1e-7f);
    EXPECT_LT(length(place(bound[i], ball.triangles, grown) - 1.2f * points[i]), 1e-7f);
  }
}

// What the field leaves on a scene over 20 phases between the keyframes.
struct Agreement {
  std::vector<float> miss_m;         // of vertices that could be seen at the reference phase
  std::vector<float> groove_miss_m;  // the same of the tissue that fills the grooves
  double folded = 0, points = 0;     // places that turned over, of all
  struct Staying {
    // covered: by the meshes themselves, where a stronger structure now hides the place of the
    // wall's surface that was nearest; near: out of the wall by less than kBorder_m.
    double stay = 0, near = 0, covered = 0, points = 0;
    double part() const { return (stay + near) / (points - covered); }
  };
  std::map<std::string, Staying> walls;  // of tissue: who stays within its structure
};

// Where the surface's point now is that was nearest to a reference place.
Vec3f carriedBySurface(const SurfaceTopology& surface, Vec3f reference_m,
                       const SurfaceFrame& at_reference, const SurfaceFrame& now) {
  const std::size_t s = index(surface.id);
  const BoundPoint bound = bindToSurface(surface.id, surface.triangles, at_reference.positions_m[s],
                                         std::vector{reference_m})
                               .front();
  return place(bound, surface.triangles, now.positions_m[s]);
}

// Does it stand within kBorder_m of the wall's border? The field meets the surfaces to a few tenths
// of a millimetre.
constexpr float kBorder_m = 0.1e-3f;
bool onBorder(SurfaceId id, const std::vector<SurfaceTopology>& surfaces, const SurfaceFrame& now,
              Vec3f place_m) {
  const auto& triangles = surfaces[index(id)].triangles;
  const auto& positions_m = now.positions_m[index(id)];
  const BoundPoint bound = bindToSurface(id, triangles, positions_m, std::vector{place_m}).front();
  return length(place(bound, triangles, positions_m) - place_m) < kBorder_m;
}

TopSurfaces topSurfacesOf(const Scene& scene, const MeshMotion& motion, const SurfaceFrame& frame) {
  std::vector<TopSurfaces::Closed> closed;
  for (const SurfaceTopology& s : motion.surfaces())
    if (!s.membrane)
      closed.push_back({s.id, scene.structures[index(s.id)].priority,
                        Columns(s.triangles, frame.positions_m[index(s.id)])});
  return TopSurfaces(std::move(closed));
}

Agreement agreementOf(const Scene& scene) {
  const MeshMotion motion(scene);
  const MotionField field = interiorMotion(scene, motion);
  SurfaceFrame at_reference, now;
  motion.frameAt(0, at_reference);
  const TopSurfaces reference = topSurfacesOf(scene, motion, at_reference);
  Agreement result;
  FieldFrame frame;
  for (int i = 0; i < 20; ++i) {
    const double phase = (i + 0.37) / 20;
    field.at(phase, frame);
    motion.frameAt(phase, now);
    const TopSurfaces tops = topSurfacesOf(scene, motion, now);
    for (const SurfaceTopology& s : motion.surfaces()) {
      if (s.membrane || s.still) continue;
      const GroupFrame& group = frame[field.groupOf(s.id)];
      Box box;
      const auto& positions_m = at_reference.positions_m[index(s.id)];
      for (std::size_t v = 0; v < positions_m.size(); v += 3) {
        box.add(toDouble(positions_m[v]));
        if (reference.hides(toDouble(positions_m[v]), s.id)) continue;
        const bool grooves = scene.structures[index(s.id)].name == "grooves";
        (grooves ? result.groove_miss_m : result.miss_m)
            .push_back(length(group.place(positions_m[v]) - now.positions_m[index(s.id)][v]));
      }
      for (std::uint64_t j = 0; j < 3000; ++j) {
        const Vec3d p{box.lo.x + uniformFromHash(hashOf(j, 1)) * (box.hi.x - box.lo.x),
                      box.lo.y + uniformFromHash(hashOf(j, 2)) * (box.hi.y - box.lo.y),
                      box.lo.z + uniformFromHash(hashOf(j, 3)) * (box.hi.z - box.lo.z)};
        if (reference.at(p) != s.id) continue;
        ++result.points;
        result.folded += group.volumeRatio(toFloat(p)) <= 0 ? 1 : 0;
        const std::string& name = scene.structures[index(s.id)].name;
        if (name.find("wall") == std::string::npos) continue;
        Agreement::Staying& of_wall = result.walls[name];
        ++of_wall.points;
        const Vec3f placed = group.place(toFloat(p));
        const auto top = tops.at(toDouble(placed));
        if (top == s.id)
          ++of_wall.stay;
        else if (tops.hides(toDouble(carriedBySurface(s, toFloat(p), at_reference, now)), s.id))
          ++of_wall.covered;
        else
          of_wall.near += onBorder(tops.hides(toDouble(placed), s.id) ? *top : s.id,
                                   motion.surfaces(), now, placed);
      }
    }
  }
  std::sort(result.miss_m.begin(), result.miss_m.end());
  std::sort(result.groove_miss_m.begin(), result.groove_miss_m.end());
  return result;
}

double rootMeanSquare(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v) * static_cast<double>(v);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

void expectAgreement(const Agreement& a, double rms_m) {
  ::testing::Test::RecordProperty("rms_um", static_cast<int>(1e6 * rootMeanSquare(a.miss_m)));
  EXPECT_LT(rootMeanSquare(a.miss_m), rms_m);
  EXPECT_LT(a.miss_m[a.miss_m.size() * 99 / 100], 0.5e-3f);
  // They slide along the walls, and their layer is thinner than a cell of the field.
  if (const auto& g = a.groove_miss_m; !g.empty()) {
    EXPECT_LT(g[g.size() * 9 / 10], 1.6e-3f);
  }
  std::printf("%.0f of %.0f places turned over\n", a.folded, a.points);
  EXPECT_LE(a.folded, 1e-4 * a.points);  // in layers thinner than a cell
  for (const auto& [name, wall] : a.walls) {
    std::printf("%s: %.2f %% of its points stay, %.2f %% are on its border, %.2f %% covered\n",
                name.c_str(), 100 * wall.stay / wall.points, 100 * wall.near / wall.points,
                100 * wall.covered / wall.points);
    EXPECT_GT(wall.part(), 0.98) << name;
  }
}

TEST(MaterialPointsLaw, TheShippedHeartCarriesThem) {
  expectAgreement(agreementOf(readScene(std::filesystem::path(support::kSourceDir) /
                                        "examples/beating_heart/scene.toml")),
                  0.3e-3);
}

TEST(MaterialPointsLaw, ARealHeartCarriesThem) {
  if (!std::filesystem::exists(support::patientMeshes())) GTEST_SKIP() << "no real meshes here";
  const support::TempFolder folder;
  expectAgreement(
      agreementOf(parseScene(support::patientScene().text(), folder.path() / "scene.toml")),
      0.15e-3);
}

}  // namespace
}  // namespace echocine
