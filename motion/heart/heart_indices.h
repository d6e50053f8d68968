#pragma once
// Indices of the left ventricle as cohorts report them: means and correlations of two groups of
// people, and the dials of the parametric heart that have given indices.

#include <array>
#include <cstddef>

namespace echocine::heart {

// Indices of a left ventricle. Means, SD and correlations are those of 1,991 healthy people and 300
// with an infarct: Cardiac Atlas Project, github.com/CardiacAtlasProject/lv-ortho-modes,
// clinical_index.csv. That repository states no licence; only these statistics are used, none of
// its records. Correlations of at most 0.15 are set to 0.
enum HeartIndex : std::size_t {
  kVolumeIndex,      // end-diastolic volume / body surface, mL/m2
  kSphericityIndex,  // end-diastolic volume / sphere on the long axis, %
  kEjectionIndex,    // ejection fraction, %
  kWallIndex,        // 2 x posterior wall / short-axis diameter at end-diastole, %
  kConicityIndex,    // apical / basal diameter, %
  kShorteningIndex,  // of the distance from base to apex, %
  kHeartIndices
};
inline constexpr const char* kIndexSource =
    "Cardiac Atlas Project, github.com/CardiacAtlasProject/lv-ortho-modes, clinical_index.csv: "
    "statistics only; the repository states no licence";
using HeartIndices = std::array<double, kHeartIndices>;

// The dials of the parametric heart that follow from indices, in the order of kIndexDials.
enum IndexDial : std::size_t {
  kEf,
  kEdv_ml,
  kWall_mm,
  kSphericity,
  kMapse_mm,
  kConicity,
  kIndexDialCount
};
using IndexDials = std::array<double, kIndexDialCount>;
inline constexpr std::array<const char*, kIndexDialCount> kIndexDials{
    "ef", "edv", "wall-thickness", "sphericity", "mapse", "conicity"};

// A group of people: means and SD of their indices, correlations row by row.
struct HeartGroup {
  const char* name;
  double share;  // of the mixture; our choice: equal parts, as people sent for an echo
  HeartIndices mean, sd;
  std::array<double, kHeartIndices * kHeartIndices> correlation;
};
const std::array<HeartGroup, 2>& heartGroups();

// Body surface: mean and SD in m2, independent of the indices. Our choice: adults.
inline constexpr double kBodySurface_m2 = 1.85, kBodySurfaceSd_m2 = 0.22;

// The mid inferolateral wall of the parametric heart at end-diastole relative to its septum, and
// the motion of the apex towards the base at end-systole relative to the long axis.
inline constexpr double kPosteriorShare = 0.85, kApexRise = 0.035;

// k and L of indicesOf(), and the derivative of log k by the conicity.
double sphereShare(double conicity);
double sphereShareSlope(double conicity);
double longAxis_mm(double edv_ml, double sphericity, double conicity);

// Indices of the parametric heart with these dials, in the order V, S, E, W, B, C:
//   V = edv/b,   S = 100 k s^2,   E = 100 ef,   W = 200 p h / (s L),   B = 100 (m/L + a),
//   C = 100 q,   L^3 = 6 edv / (pi k s^2):  the long axis at end-diastole,
// s: sphericity dial, h: septum, m: excursion of the ring, q: conicity, b: body surface. k follows
// from the outline of the heart's wall and q; p is kPosteriorShare, a kApexRise. Precondition:
// dials above 0.
IndexDials indicesOf(const IndexDials& dials, double body_surface_m2 = kBodySurface_m2);
inline constexpr std::array<HeartIndex, kIndexDialCount> kIndexOfRow{
    kVolumeIndex, kSphericityIndex, kEjectionIndex, kWallIndex, kShorteningIndex, kConicityIndex};

// The dials of indices; inverse of indicesOf().
IndexDials dialsOf(const HeartIndices& indices, double body_surface_m2 = kBodySurface_m2);

}  // namespace echocine::heart
