#pragma once
// Hearts as measured: dials drawn jointly from the indices of a group of people.

#include <cstdint>
#include <functional>
#include <vector>

#include "motion/heart/heart_indices.h"

namespace echocine::dataset {

// Body surface of a sex, m2. Our choice; both in equal parts have mean 1.85 and SD 0.22.
inline constexpr double kMenSurface_m2 = 1.97, kWomenSurface_m2 = 1.73, kSurfaceSd_m2 = 0.184;

// Indices of a group, truncated to what the dials of the parametric heart can have. The normal
// distribution before truncation is such that the indices have the group's means, SD and
// correlations after it; it is found by fixed-point iteration over fixed draws.
class IndexDraws {
 public:
  // Standard normals, by number.
  using Normals = std::function<double(std::size_t number)>;

  // group: of heart::heartGroups().
  static const IndexDraws& of(std::size_t group);

  struct Drawn {
    heart::HeartIndices indices{};
    heart::IndexDials dials{};
    double body_surface_m2 = 0;
    double ejection_score = 0;  // standard score of the ejection fraction in its group
  };
  // surface_m2: mean of the body surface. `normals` is called with consecutive numbers until the
  // dials are within their ranges. Throws SceneError after 1,000 draws.
  Drawn draw(double surface_m2, const Normals& normals) const;

 private:
  explicit IndexDraws(const heart::HeartGroup& group);

  const heart::HeartGroup& group_;
  heart::HeartIndices mean_;
  std::vector<double> factor_;  // Cholesky
};

}  // namespace echocine::dataset
