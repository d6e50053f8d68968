// A family's surfaces as modes, against the plain sum over its hearts.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/hash_random.h"
#include "core/units.h"
#include "fit/blended_beat.h"
#include "geometry/plane_slice.h"
#include "motion/surfaces/probe_placement.h"
#include "support/array_probe.h"
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

// Law: a blend by shares of a polynomial is that of the hearts themselves, with no more modes than
// the polynomial has terms beside its constant.
TEST(SurfaceModesLaw, APolynomialNeedsNoMoreModesThanTerms) {
  Balls balls;
  // Least squares of a straight line through places -1 to 1.
  const auto placeOf = [](int n) { return 2.0 * n / (kHearts - 1) - 1; };
  double squares = 0;
  for (int n = 0; n < kHearts; ++n) squares += placeOf(n) * placeOf(n);
  const auto sharesAt = [&](double place) {
    std::vector<double> shares;
    for (int n = 0; n < kHearts; ++n)
      shares.push_back(1.0 / kHearts + place * placeOf(n) / squares);
    return shares;
  };
  std::vector<std::vector<double>> at_places;
  std::vector<const SurfaceFrame*> hearts;
  for (int n = 0; n < kHearts; ++n) {
    at_places.push_back(sharesAt(placeOf(n)));
    SurfaceFrame& heart = balls.hearts[static_cast<std::size_t>(n)];
    for (std::size_t s = 0; s < 2; ++s)  // no two hearts differ alike
      for (std::size_t v = 0; v < heart.positions_m[s].size(); ++v)
        heart.positions_m[s][v].y += static_cast<float>(1e-3 * uniformFromHash(hashOf(n, s, v)));
    hearts.push_back(&heart);
  }
  const SurfacePatches patches = patchesOf(balls.surfaces);
  EXPECT_GT(SurfaceModes(hearts, balls.kept, patches).count(), 10U);
  const SurfaceModes line(hearts, balls.kept, patches, at_places);
  EXPECT_EQ(line.count(), 1U);
  for (const double place : {-1.0, 0.0, 0.3, 1.0}) {
    const std::vector<double> exact = sharesAt(place);
    const std::vector<float> shares(exact.begin(), exact.end());
    const SurfaceFrame blend = line.blend(shares);
    for (std::size_t s = 0; s < 2; ++s)
      for (std::size_t v = 0; v < blend.positions_m[s].size(); ++v)
        ASSERT_LT(length(toDouble(blend.positions_m[s][v]) - balls.placeOf(0, s, v, shares)), 5e-6)
            << place;
  }
}

// Laws: of every triangle that the plane cuts, the corners are those of the whole blend, in its
// frame and in the next, and near_plane has the triangle; every other triangle lies on one side, as
// in the whole blend. A slice of near_plane is that of the whole frame.
TEST(SurfaceModesLaw, NearThePlaneOfAnyTiltIsTheWholeBlend) {
  const Balls balls;
  const Probe probe = arrayProbe();
  for (int draw = 0; draw < 6; ++draw) {
    const std::vector<float> shares = Balls::sharesOf(draw);
    const PlaneTilt tilt{radiansFromDegrees(7.0 * draw - 20), radiansFromDegrees(20 - 5.0 * draw)};
    const Pose pose = turnedAndTilted({}, tilt.rotate_rad, tilt.tilt_rad);
    const BlendedBeat beat(balls.modes, shares, tilt);
    std::vector<SurfaceFrame> near(kFrames);
    for (std::size_t f = 0; f < kFrames; ++f) {
      beat.frameAt((f + 1) % kFrames, near[f]);
      beat.frameAt(f, near[f]);  // in the memory of another frame
    }
    int cut = 0, left_out = 0;
    for (int f = 0; f < kFrames; ++f) {
      const SurfaceFrame& frame = near[static_cast<std::size_t>(f)];
      for (std::size_t s = 0; s < 2; ++s)
        for (std::uint32_t number = 0; number < balls.surfaces[s].triangles.size(); ++number) {
          const Triangle& t = balls.surfaces[s].triangles[number];
          int above = 0, above_near = 0;
          for (const std::uint32_t v : t) {
            above += pose.fromWorld(balls.placeOf(f, s, v, shares)).y > 0;
            above_near += frame.positions_m[s][v].y > 0;
          }
          left_out += std::abs(frame.positions_m[s][t[0]].y) == 1;
          if (above == 0 || above == 3) {
            EXPECT_EQ(above, above_near) << draw;
            continue;
          }
          ++cut;
          EXPECT_TRUE(std::any_of(frame.near_plane[s].begin(), frame.near_plane[s].end(),
                                  [&](const TriangleRange& range) {
                                    return number >= range.first && number < range.end;
                                  }));
          for (const int of : {f, (f + 1) % kFrames})
            for (const std::uint32_t v : t) {
              const Vec3d whole = pose.fromWorld(balls.placeOf(of, s, v, shares));
              EXPECT_LT(
                  length(toDouble(near[static_cast<std::size_t>(of)].positions_m[s][v]) - whole),
                  5e-6)
                  << draw;
            }
        }
      SurfaceFrame all = frame;
      all.near_plane.clear();
      PlaneSlice some(balls.surfaces, probe), whole(balls.surfaces, probe);
      some.cut(frame);
      whole.cut(all);
      ASSERT_EQ(some.edges().size(), whole.edges().size());
      for (std::size_t e = 0; e < some.edges().size(); ++e)
        EXPECT_EQ(some.edges()[e].triangle, whole.edges()[e].triangle);
    }
    EXPECT_GT(cut, 200);
    EXPECT_GT(left_out, 1000) << draw;
  }
}

}  // namespace
}  // namespace echocine::fit
