#pragma once
// Scatterers of membranes, bound to their triangles, and of chordae and fibrous rings. Their
// speckle thus moves with them through blood that renews itself.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "motion/interior/bound_point.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/valve_parts.h"
#include "speckle/point_spread.h"

namespace echocine {

class SheetPoints {
 public:
  // Uniform in area at the reference phase, hashed from the seed; those that no beam reaches at any
  // instant are omitted. At 3 per resolution cell their spacing is half a pulse's width, so a cell
  // contains many more of them than of the surrounding blood, which hardly contributes to the
  // sheet's echo.
  // Those of a leaflet with thickness are spread evenly through its body. Chordae have four times
  // as many along each spacing, all over their section. Fibrous rings have one to a cube of the
  // spacing.
  SheetPoints(const Scene& scene, const MeshMotion& motion, double reference_phase,
              ValveParts valves = {});

  std::size_t count() const { return points_.size() + on_chords_.size() + on_rings_.size(); }
  // Positions at an instant, always in the same order. Empty for a frame without
  // surfaces.
  void at(const SurfaceFrame& surfaces, std::vector<Vec3f>& places_m) const;

 private:
  struct OnChord {
    std::uint32_t chord = 0;
    float along = 0;  // 0 at the muscle to 1 at the leaflet
    Vec3f beside_m{};
  };
  void draw(const SurfaceTopology& sheet, const std::vector<Vec3f>& positions_m, double per_m2,
            const SpeckleSettings& settings);
  struct OnRing {
    std::uint32_t stretch = 0;
    float along = 0, a = 0, b = 0;  // of the stretch; of the section's disc
  };
  void drawOnChords(const Scene& scene, double apart_m);
  void drawOnRings(const Scene& scene, double per_m3);
  void dropUnseen(std::span<const SurfaceId> sheets, double reach_m);
  void onSheetsAt(const SurfaceFrame& surfaces, std::vector<Vec3f>& places_m) const;

  const MeshMotion& motion_;
  ValveParts valves_;
  std::vector<BoundPoint> points_;
  std::vector<float> through_;  // of each: -1 at the back of its body to 1 at the front
  std::vector<OnChord> on_chords_;
  std::vector<OnRing> on_rings_;
};

}  // namespace echocine
