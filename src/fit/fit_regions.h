#pragma once
// Where a loop differs from the fitted heart by more than a perfect model does.

#include <optional>
#include <string>
#include <vector>

#include "fit/fit_report.h"

namespace echocine::fit {

// One structure, or one segment of the left ventricle's wall, in one view. Offsets are those of
// the loop minus those that the heart shows against its own rendered loops, along the normal;
// positive is out of blood.
struct RegionFinding {
  std::size_t segment = 0;  // 1 to 17; 0: a structure
  std::string name;         // of the structure or segment
  double offset_mm = 0;     // mean over the beat
  double motion_mm = 0;  // at end-systole minus at end-diastole: positive where a wall moves less
  // The offset minus the mean of the adjacent visible segments, if there are two or more: a fit
  // spreads its error over the wall, a defect does not.
  std::optional<double> local_mm;
  // For a perfect model; larger for faint edges.
  double offset_sd_mm = 0, motion_sd_mm = 0, local_sd_mm = 0;
  double pieces = 0, certainty = 0;  // of its boundary in the loop (OffsetCurve)
  bool visible = false;              // enough pieces that are certain enough
  bool significant = false;  // visible, and one of them is beyond kRegionSds standard deviations

  double deviations() const;  // the largest one, in standard deviations
};

// Our choice, with the standard deviations, from planted hearts (tests/bench/fit).
inline constexpr double kRegionSds = 3;

// Rendered loops of the fitted heart in each view. Their spread is the speckle's.
inline constexpr int kTwins = 3;

// Standard deviations that the own loops of a perfect model do not show: other media, gain and
// looks, and for fitted dials the error of the fit, which is smaller with own look. From planted
// hearts (tests/bench/fit); those of fitted dials from few hearts.
struct RegionFloor {
  double segment_mm = 0, structure_mm = 0, local_mm = 0;
};
inline constexpr RegionFloor kKnownDials{0.4, 0.5, 0.35}, kFittedDials{0.9, 1.0, 0.5},
    kFittedWithOwnLook{0.5, 0.8, 0.3};

// For a fit with own look: kFittedWithOwnLook at an agreement (Eq. 23) of 1, kFittedDials at
// kPlainAgreement and below, linear between. Edges of a loop that looks different lie elsewhere.
inline constexpr double kPlainAgreement = 0.9;  // our choice
RegionFloor floorWithOwnLook(double agreement);

// Findings of all structures beside blood and all segments that the loop and all twins show, the
// structures first. A twin is the map of the heart against one of its own rendered loops.
// Precondition: two twins or more; all maps have the same structures and frames.
std::vector<RegionFinding> regionFindings(const FitReport& loop, const std::vector<FitMap>& twins,
                                          const RegionFloor& floor);

nlohmann::ordered_json regionsJson(const std::vector<RegionFinding>& regions);

}  // namespace echocine::fit
