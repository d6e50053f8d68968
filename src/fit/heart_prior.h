#pragma once
// The distribution of hearts before a loop is known: a mixture of healthy hearts and hearts with an
// infarct.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "motion/heart/heart_indices.h"

namespace echocine::fit {

using heart::HeartGroup, heart::heartGroups, heart::HeartIndices, heart::indicesOf;
using heart::kBodySurface_m2, heart::kBodySurfaceSd_m2;
using heart::kEf, heart::kEdv_ml, heart::kWall_mm, heart::kSphericity, heart::kMapse_mm,
    heart::kConicity;
using heart::kVolumeIndex, heart::kSphericityIndex, heart::kEjectionIndex, heart::kWallIndex,
    heart::kConicityIndex, heart::kShorteningIndex, heart::kHeartIndices;

// The dials that follow from indices, in the order of kPriorDials.
inline constexpr std::size_t kPriorDialCount = heart::kIndexDialCount;
using PriorDials = heart::IndexDials;
inline constexpr std::array<const char*, kPriorDialCount> kPriorDials = heart::kIndexDials;

// The number of a dial in kPriorDials; none for a dial without a prior.
std::optional<std::size_t> priorDialOf(const std::string& key);

// A dial with a prior of its own, independent of the others: log-normal, or normal about 0.
struct LonePrior {
  const char* key;
  double median;
  double spread;  // of the logarithm; of the dial if the median is 0
  double sd() const { return median == 0 ? spread : median * spread; }
  // Log of the density, without its constant.
  double logDensity(double value) const;
};
// Largest volume of the left atrium, mL. Healthy adults have 25 +- 7 mL/m2 and up to 34; 48 is
// severely enlarged (Lang et al., J. Am. Soc. Echocardiogr. 28, 2015). The spread, which covers
// both, is our choice. Inward motion towards the apex relative to the base: our choice. Volume of
// the right ventricle over that of the left one: that of the default heart; the spread is our
// choice. Bows and ellipticities: two published hearts differ from the model by up to 0.035 and
// 0.25, at four heights. Ratios of thickness: our choice.
inline constexpr LonePrior kLonePriors[] = {
    {"la-volume", 55, 0.35},        {"apical-motion", 1, 0.2},     {"rv-ratio", 1.04, 0.12},
    {"bow-lateral", 0, 0.03},       {"bow-anterior", 0, 0.03},     {"ellipticity", 0, 0.15},
    {"ellipticity-45", 0, 0.15},    {"apical-thickness", 1, 0.15}, {"lateral-thickness", 1, 0.15},
    {"anterior-thickness", 1, 0.15}};
const LonePrior* lonePriorOf(const std::string& key);  // null: none

class HeartPrior {
 public:
  HeartPrior();

  // Log of the density of the dials: of the mixture's normal distributions of V, S, E, W, B, C,
  // times the Jacobian of indicesOf(). V has the mean and the covariances of a volume index times
  // an unknown body surface. gradient: of the result, by dial; may be null.
  double logDensity(const PriorDials& dials, PriorDials* gradient = nullptr) const;

  // A draw is a hash of seed and number. It is a normal one: an index may lie beyond the dials.
  HeartIndices draw(std::uint64_t seed, std::uint64_t number) const;
  HeartIndices draw(std::size_t group, std::uint64_t seed, std::uint64_t number) const;
  // The dials of drawn indices; body surface in m2. Inverse of indicesOf() for the mean surface.
  static PriorDials dialsOf(const HeartIndices& indices, double body_surface_m2 = kBodySurface_m2) {
    return heart::dialsOf(indices, body_surface_m2);
  }

  // Mean and SD of each dial over 4,000 draws within the dials' ranges, for comparison with a
  // posterior.
  const PriorDials& mean() const { return mean_; }
  const PriorDials& sd() const { return sd_; }
  // SD of a dial, also of kLonePriors; none for a dial without a prior.
  std::optional<double> sdOf(const std::string& key) const;

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
