#pragma once
// The scan line of an M-mode: by angle, by offset, or through a valve.

#include <optional>

#include "scene/named.h"
#include "scene/scene.h"
#include "truth/truth_values.h"

namespace echocine {

// Anatomical places of the cursor at end-diastole. Lateral and septal: the hinge of the valve in
// the imaging plane that is farther from, or nearer to, the other ring (tricuspid; without one,
// aortic).
enum class MModeTarget {
  mitral_tips,
  mitral_lateral,
  mitral_septal,
  tricuspid_lateral,
  aortic_valve
};

template <>
struct NamesOf<MModeTarget> {
  static constexpr Named<MModeTarget> kAll[] = {
      {MModeTarget::mitral_tips, "mitral-tips"},
      {MModeTarget::mitral_lateral, "mitral-lateral"},
      {MModeTarget::mitral_septal, "mitral-septal"},
      {MModeTarget::tricuspid_lateral, "tricuspid-lateral"},
      {MModeTarget::aortic_valve, "aortic-valve"}};
};

// Is the target a point of a ring, so that its excursion is measured?
constexpr bool isRing(MModeTarget target) {
  return target == MModeTarget::mitral_lateral || target == MModeTarget::mitral_septal ||
         target == MModeTarget::tricuspid_lateral;
}

// Throws SceneError if the scene has no structure of a role that the target needs: those of the
// heart's function, and the valve for its tips.
void refuseWithoutRoles(const Scene& scene, MModeTarget target);

// The target in the imaging plane, m, from the truth of one frame (function and contours). None if
// the plane does not cut the valve.
std::optional<Vec3d> targetIn(const FrameTruth& truth, const Scene& scene, MModeTarget target);

// The place given as an angle or as an offset, in degrees or mm; none for neither. Throws
// SceneError for the one that the probe's lines do not have.
std::optional<double> placeGiven(const Probe& probe, std::optional<double> angle_deg,
                                 std::optional<double> offset_mm);

// The scan line nearest to an angle (rad; linear probes: an offset, m). Throws SceneError, named by
// `option`, for a place outside the sector by more than half the spacing of lines.
int lineAt(const Probe& probe, double place, const char* option);

// The scan line nearest to a point of the imaging plane. Throws SceneError if the point lies
// outside the sector.
int lineThrough(const Probe& probe, Vec3d point_m, MModeTarget target);

}  // namespace echocine
