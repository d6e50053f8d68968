// A family's surfaces as modes, against the plain sum over its hearts.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/hash_random.h"
#include "core/units.h"
#include "fit/surface_modes.h"
#include "motion/surfaces/probe_placement.h"
#include "support/meshes.h"

namespace echocine::fit {
namespace {

using namespace support;

constexpr int kHearts = 12, kFrames = 5;

// Two balls that shift, grow and bend from heart to heart and over the beat.
struct Balls {
  Balls() {
    std::vector<Vec3f> places;
    for (const Vec3d p : ball.points) places.push_back(toFloat(p));
    std::vector<std::uint32_t> order(places.size()), number(places.size());
    std::iota(order.begin(), order.end(), 0u);
    orderByPlace(places, order);
    for (std::uint32_t i = 0; i < order.size(); ++i) number[order[i]] = i;
    std::vector<Triangle> triangles = ball.triangles;
    for (Triangle& t : triangles)
      for (std::uint32_t& v : t) v = number[v];
    for (const std::uint32_t s : {0u, 1u}) {
      surfaces.push_back({static_cast<SurfaceId>(s), triangles,
                          static_cast<std::uint32_t>(order.size()), false, false});
      kept.push_back(order);
    }
    const SurfacePatches patches = patchesOf(surfaces);
    for (int f = 0; f < kFrames; ++f) {
      for (int n = 0; n < kHearts; ++n) hearts.push_back(heart(n, f));
      std::vector<const SurfaceFrame*> of_frame;
      for (int n = 0; n < kHearts; ++n)
        of_frame.push_back(&hearts[static_cast<std::size_t>(f * kHearts + n)]);
      modes.emplace_back(of_frame, kept, patches);
    }
  }

  SurfaceFrame heart(int n, int f) const {
    SurfaceFrame frame;
    for (int s = 0; s < 2; ++s) {
      std::vector<Vec3f>& points_m = frame.positions_m.emplace_back();
      const double grown = 1 + 0.02 * n - 0.05 * std::sin(1.3 * f), shift = 0.01 * s + 0.002 * f;
      for (const Vec3d p : ball.points)
        points_m.push_back(
            toFloat(0.04 * grown * p + Vec3d{shift, 0.02 * s + 0.0005 * n * p.x * p.z, 0.07}));
    }
    return frame;
  }

  // Sum 1, some below 0.
  static std::vector<float> sharesOf(int draw) {
    std::vector<float> shares;
    float sum = 0;
    for (int n = 0; n < kHearts; ++n) {
      shares.push_back(static_cast<float>(uniformFromHash(hashOf(draw, n)) - 0.3));
      sum += shares.back();
    }
    for (float& share : shares) share /= sum;
    return shares;
  }

  // The plain sum at a kept vertex, in double precision.
  Vec3d placeOf(int f, std::size_t s, std::size_t v, const std::vector<float>& shares) const {
    Vec3d sum;
    for (std::size_t n = 0; n < shares.size(); ++n)
      sum = sum +
            static_cast<double>(shares[n]) *
                toDouble(
                    hearts[static_cast<std::size_t>(f) * kHearts + n].positions_m[s][kept[s][v]]);
    return sum;
  }

  const Mesh ball = icosphere(4, 1);
  std::vector<SurfaceTopology> surfaces;
  std::vector<std::vector<std::uint32_t>> kept;
  std::vector<SurfaceFrame> hearts;  // by frame, by number
  std::vector<SurfaceModes> modes;
};

TEST(SurfaceModesLaw, ABlendIsTheSumOverHearts) {
  const Balls balls;
  for (int draw = 0; draw < 4; ++draw) {
    const std::vector<float> shares = Balls::sharesOf(draw);
    for (int f = 0; f < kFrames; ++f) {
      const SurfaceFrame blend = balls.modes[static_cast<std::size_t>(f)].blend(shares);
      for (std::size_t s = 0; s < 2; ++s)
        for (std::size_t v = 0; v < blend.positions_m[s].size(); ++v)
          ASSERT_LT(length(toDouble(blend.positions_m[s][v]) - balls.placeOf(f, s, v, shares)),
                    5e-6)
              << draw << " " << f << " " << s << " " << v;
    }
  }
}

// Balls that grow and shift alike need few modes.
TEST(SurfaceModesLaw, ModesAreAsManyAsTheHeartsDiffer) {
  const Balls balls;
  for (const SurfaceModes& modes : balls.modes) EXPECT_LE(modes.count(), 2U);
}

// Law: of every triangle that the plane cuts, the corners are those of the whole blend, in its
// frame and in the next; every other triangle lies on one side, as in the whole blend.
TEST(SurfaceModesLaw, NearThePlaneOfAnyTiltIsTheWholeBlend) {
  const Balls balls;
  for (int draw = 0; draw < 6; ++draw) {
    const std::vector<float> shares = Balls::sharesOf(draw);
    const PlaneTilt tilt{radiansFromDegrees(7.0 * draw - 20), radiansFromDegrees(20 - 5.0 * draw)};
    const Pose pose = turnedAndTilted({}, tilt.rotate_rad, tilt.tilt_rad);
    const std::vector<SurfaceFrame> near = blendNearPlane(balls.modes, shares, tilt);
    int cut = 0, left_out = 0;
    for (int f = 0; f < kFrames; ++f)
      for (std::size_t s = 0; s < 2; ++s)
        for (const Triangle& t : balls.surfaces[s].triangles) {
          int above = 0, above_near = 0;
          for (const std::uint32_t v : t) {
            above += pose.fromWorld(balls.placeOf(f, s, v, shares)).y > 0;
            above_near += near[static_cast<std::size_t>(f)].positions_m[s][v].y > 0;
          }
          left_out += std::abs(near[static_cast<std::size_t>(f)].positions_m[s][t[0]].y) == 1;
          if (above == 0 || above == 3) {
            EXPECT_EQ(above, above_near) << draw;
            continue;
          }
          ++cut;
          for (const int frame : {f, (f + 1) % kFrames})
            for (const std::uint32_t v : t) {
              const Vec3d whole = pose.fromWorld(balls.placeOf(frame, s, v, shares));
              EXPECT_LT(
                  length(toDouble(near[static_cast<std::size_t>(frame)].positions_m[s][v]) - whole),
                  5e-6)
                  << draw;
            }
        }
    EXPECT_GT(cut, 200);
    EXPECT_GT(left_out, 1000) << draw;
  }
}

}  // namespace
}  // namespace echocine::fit
