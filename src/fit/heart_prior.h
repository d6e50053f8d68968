#pragma once
// The distribution of hearts before a loop is known: a mixture of healthy hearts and hearts with an
// infarct.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace echocine::fit {

// Indices of a left ventricle. Means, SD and correlations are those of 1,991 healthy people and 300
// with an infarct: Cardiac Atlas Project, github.com/CardiacAtlasProject/lv-ortho-modes,
// clinical_index.csv. That repository states no licence; only these statistics are used, none of
// its records. Correlations of at most 0.15 are set to 0.
enum HeartIndex : std::size_t {
  kVolumeIndex,      // end-diastolic volume / body surface, mL/m2
  kSphericityIndex,  // end-diastolic volume / sphere on the long axis, %
  kEjectionIndex,    // ejection fraction, %
  kWallIndex,        // 2 x posterior wall / short-axis diameter at end-diastole, %
  kConicityIndex,    // apical / basal diameter, %; no dial of the parametric heart changes it
  kShorteningIndex,  // of the distance from base to apex, %
  kHeartIndices
};
using HeartIndices = std::array<double, kHeartIndices>;

// The dials of the parametric heart that follow from indices, in the order of kPriorDials.
enum PriorDial : std::size_t { kEf, kEdv_ml, kWall_mm, kSphericity, kMapse_mm, kPriorDialCount };
using PriorDials = std::array<double, kPriorDialCount>;
inline constexpr std::array<const char*, kPriorDialCount> kPriorDials{"ef", "edv", "wall-thickness",
                                                                      "sphericity", "mapse"};

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

// Indices, without conicity, of the parametric heart with these dials and the mean body surface:
//   V = edv/b,   S = 100 k s^2,   E = 100 ef,   W = 200 p h / (s L),   B = 100 (m/L + a),
//   L^3 = edv / (c s^2):  the long axis at end-diastole,
// s: sphericity dial, h: septum, m: excursion of the ring, b: kBodySurface_m2. k and c follow from
// the outline of the heart's wall; p is the posterior wall relative to the septum, a the rise of
// the apex relative to L. Precondition: dials above 0.
PriorDials indicesOf(const PriorDials& dials);

// The number of a dial in kPriorDials; none for a dial without a prior.
std::optional<std::size_t> priorDialOf(const std::string& key);

class HeartPrior {
 public:
  HeartPrior();

  // Log of the density of the dials: of the mixture's normal distributions of V, S, E, W, B, times
  // the Jacobian of indicesOf(). V has the mean and the covariances of a volume index times an
  // unknown body surface. gradient: of the result, by dial; may be null.
  double logDensity(const PriorDials& dials, PriorDials* gradient = nullptr) const;

  // A draw is a hash of seed and number. It is a normal one: an index may lie beyond the dials.
  HeartIndices draw(std::uint64_t seed, std::uint64_t number) const;
  HeartIndices draw(std::size_t group, std::uint64_t seed, std::uint64_t number) const;
  // The dials of drawn indices; body surface in m2. Inverse of indicesOf() for the mean surface.
  static PriorDials dialsOf(const HeartIndices& indices, double body_surface_m2 = kBodySurface_m2);

  // Mean and SD of each dial over 4,000 draws within the dials' ranges, for comparison with a
  // posterior.
  const PriorDials& mean() const { return mean_; }
  const PriorDials& sd() const { return sd_; }

 private:
  struct Normal {
    double log_scale;  // log of share / normalisation
    PriorDials mean;
    std::vector<double> factor;  // Cholesky, kPriorDialCount^2
    // Log of its density times its share, and the gradient.
    double logAt(const PriorDials& x, PriorDials& slope) const;
  };
  static Normal normalOf(const HeartGroup& group, const std::vector<double>& covariance);
  void findMoments();

  std::vector<Normal> normals_;
  std::array<std::vector<double>, 2> factors_;  // of all indices, by group
  PriorDials mean_{}, sd_{};
};

}  // namespace echocine::fit
