#include "motion/heart/heart_indices.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/heart/wall_place.h"

namespace echocine::heart {
namespace {

OutlineSize sizeOf(double conicity) {
  return outlineSize(std::log(conicity / outlineConicity()));
}

}  // namespace

double sphereShare(double conicity) {
  const OutlineSize outline = sizeOf(conicity);
  return outline.volume / (4 * outline.widest * outline.widest) * 6 / std::numbers::pi;
}

double sphereShareSlope(double conicity) {
  const OutlineSize outline = sizeOf(conicity);
  return (outline.volume_slope - 2 * outline.widest_slope) / conicity;
}

double longAxis_mm(double edv_ml, double sphericity, double conicity) {
  return std::cbrt(1e3 * edv_ml * 6 /
                   (std::numbers::pi * sphereShare(conicity) * sphericity * sphericity));
}

const std::array<HeartGroup, 2>& heartGroups() {
  static const std::array<HeartGroup, 2> kGroups{{{"healthy",
                                                   0.5,
                                                   {67.8, 37.6, 62.9, 39.7, 74.4, 13.4},
                                                   {13.3, 7.8, 7.3, 9.5, 7.7, 3.6},
                                                   {1,     0.20,  -0.29, -0.33, 0,    0.04,  //
                                                    0.20,  1,     0,     -0.23, 0,    0,     //
                                                    -0.29, 0,     1,     0.06,  0.25, 0.34,  //
                                                    -0.33, -0.23, 0.06,  1,     0.29, 0,     //
                                                    0,     0,     0.25,  0.29,  1,    0.25,  //
                                                    0.04,  0,     0.34,  0,     0.25, 1}},
                                                  {"infarct",
                                                   0.5,
                                                   {96.5, 41.3, 41.3, 35.2, 70.3, 8.1},
                                                   {25.0, 8.6, 11.0, 8.4, 7.9, 3.3},
                                                   {1,     0.39,  -0.61, -0.46, 0,     -0.48,  //
                                                    0.39,  1,     -0.19, -0.48, -0.48, 0,      //
                                                    -0.61, -0.19, 1,     0.32,  0,     0.76,   //
                                                    -0.46, -0.48, 0.32,  1,     0.41,  0,      //
                                                    0,     -0.48, 0,     0.41,  1,     0,      //
                                                    -0.48, 0,     0.76,  0,     0,     1}}}};
  return kGroups;
}

IndexDials indicesOf(const IndexDials& d, double body_surface_m2) {
  const double s = d[kSphericity], length = longAxis_mm(d[kEdv_ml], s, d[kConicity]);
  return {d[kEdv_ml] / body_surface_m2,
          100 * sphereShare(d[kConicity]) * s * s,
          100 * d[kEf],
          200 * kPosteriorShare * d[kWall_mm] / (s * length),
          100 * (d[kMapse_mm] / length + kApexRise),
          100 * d[kConicity]};
}

IndexDials dialsOf(const HeartIndices& indices, double body_surface_m2) {
  IndexDials d{};
  d[kEf] = indices[kEjectionIndex] / 100;
  d[kEdv_ml] = indices[kVolumeIndex] * body_surface_m2;
  // A drawn index may be beyond what an outline can have.
  constexpr double kLeastConicity = 0.1;
  d[kConicity] = std::max(indices[kConicityIndex] / 100, kLeastConicity);
  d[kSphericity] =
      std::sqrt(std::max(0.0, indices[kSphericityIndex]) / (100 * sphereShare(d[kConicity])));
  const double length = longAxis_mm(d[kEdv_ml], d[kSphericity], d[kConicity]);
  d[kWall_mm] = indices[kWallIndex] * d[kSphericity] * length / (200 * kPosteriorShare);
  d[kMapse_mm] = length * (indices[kShorteningIndex] / 100 - kApexRise);
  return d;
}

}  // namespace echocine::heart
