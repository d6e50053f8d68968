#pragma once
// All shapes of the heart at one instant, fitted to each other.

#include <array>
#include <optional>

#include "motion/heart/balloon.h"
#include "motion/heart/epicardium.h"
#include "motion/heart/heart_cycle.h"
#include "motion/heart/leaflet.h"
#include "motion/heart/left_ventricle.h"
#include "motion/heart/parameters.h"
#include "motion/heart/right_ventricle.h"
#include "motion/heart/tube.h"

namespace echocine::heart {

struct WallThickness {
  double rv_m, atrium_m, vessel_m;
};

class Instant {
 public:
  static constexpr int kAtriumFrequency = 8;  // of the atria's sphere meshes

  // `at_rest` is the left ventricle at end-diastole, which is costly to compute. Throws SceneError
  // if a chamber cannot reach its volume beside its neighbours.
  Instant(const Parameters& parameters, const LeftVentricle& at_rest, const State& now);

  Instant(const Instant&) = delete;  // its shapes refer to each other

  const State& state() const { return state_; }
  const LeftVentricle& left() const { return left_; }
  const RightVentricle& right() const { return *right_; }
  const Tube& aorta() const { return *aorta_; }
  const Tube& pulmonaryArtery() const { return *pulmonary_artery_; }
  const WallThickness& walls() const { return walls_; }
  const ValveRing& mitral() const { return mitral_; }
  const ValveRing& tricuspid() const { return tricuspid_; }
  const ValveRing& aortic() const { return aortic_; }
  const ValveRing& pulmonary() const { return pulmonary_; }

  // Points of the atria for geodesicSphere(kAtriumFrequency), dilated by a thickness. The left
  // atrium yields to the aorta, the right one to the whole left heart.
  std::vector<Vec3d> leftAtrium(double thickness_m = 0) const;
  std::vector<Vec3d> rightAtrium(double thickness_m = 0) const;
  std::vector<Vec3d> papillary(std::size_t number, const SphereMesh& sphere) const;

 private:
  void buildRightVentricle(const Parameters& parameters);
  void buildVessels();
  void buildAtria(const Parameters& parameters);
  void joinAtria();
  void buildPapillaries();

  State state_;
  LeftVentricle left_;
  std::optional<Epicardium> epicardium_;
  std::optional<RightVentricle> right_;
  std::optional<Tube> aorta_, pulmonary_artery_;
  Balloon la_, ra_;
  std::vector<Vec3d> la_points_, ra_points_;
  std::array<Balloon, 2> papillaries_;
  ValveRing mitral_, tricuspid_, aortic_, pulmonary_;
  WallThickness walls_{};
};

}  // namespace echocine::heart
