#pragma once
// Leaflets and cusps of the valves as bodies with thickness, for the picture and its echoes only.
// The mesh of a leaflet is the middle surface of its body. Contours, labels and motion are those of
// the mesh; a leaflet has no volume there.

#include <cstdint>
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/sheet_outline.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

class LeafletBodies {
 public:
  // For the scene's leaflets (hasThickness()). Those whose mesh is closed or branches stay sheets.
  // The thickness is leafletThickness() where a leaflet moves least, and twice that where
  // it moves most, at its free edge. It is halved at the outline, and locally where a face would be
  // inverted at any of 16 phases.
  LeafletBodies(const Scene& scene, const MeshMotion& motion);

  // All surfaces of the motion, with closed bodies in place of leaflets.
  const std::vector<SurfaceTopology>& surfaces() const { return surfaces_; }
  bool isBody(SurfaceId surface) const { return !half_m_[index(surface)].empty(); }

  // A frame's sheets, stored while it shows the bodies.
  struct Sheets {
    std::vector<std::vector<Vec3f>> positions_m, normals;
  };
  // Replaces the sheets of a frame of the motion by their bodies. Thread-safe.
  void thicken(SurfaceFrame& frame, Sheets& sheets) const;
  // Restores the frame.
  void thin(SurfaceFrame& frame, Sheets& sheets) const;

  // By vertex of a sheet: from the sheet to the front of its body, m. Precondition: isBody().
  void toFront(SurfaceId surface, const std::vector<Vec3f>& sheet_m,
               std::vector<Vec3f>& front_m) const;

 private:
  void addBody(const SurfaceTopology& sheet, const SheetOutline& outline);

  std::vector<SurfaceTopology> surfaces_;
  std::vector<std::vector<Triangle>> sheets_;  // faces of the leaflets, by surface
  std::vector<std::vector<float>> half_m_;     // half the thickness by vertex; empty: no body
};

}  // namespace echocine
