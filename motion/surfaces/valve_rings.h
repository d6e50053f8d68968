#pragma once
// Fibrous rings of the mitral and tricuspid valves: cords of dense collagen along the hinges of the
// leaflets. They are in the picture only; no mesh and no truth contains them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/sheet_outline.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

class ValveRings {
 public:
  // A place of a ring: the middle of its section, and unit vectors that span the section.
  struct Section {
    Vec3f middle_m, outward, axis;
  };
  // The cord between two sections. Its leaflet is that of the hinge.
  struct Stretch {
    SurfaceId leaflet{};
    std::uint32_t from = 0, to = 0;  // sections
    double length_m = 0;             // at the first instant of the beat
  };

  // For mitral and tricuspid leaflets whose mesh is an open sheet. The hinge is the part of the
  // outline that is far from the middle of the ring and stays at one height over its plane: the
  // height changes by at most a quarter of the largest change over the beat. A leaflet that does
  // not move is hinged all round.
  // The mitral ring is open where it is nearest to the aorta, because the anterior leaflet
  // continues into the aortic root there. The cord of `leaflets.annulus_mm` lies outside the hinge
  // and touches it.
  ValveRings(const Scene& scene, const MeshMotion& motion);

  const std::vector<Stretch>& stretches() const { return stretches_; }
  double radius() const { return radius_m_; }  // m

  // All sections at an instant, probe frame. Precondition: `frame` is one of the motion.
  // Thread-safe.
  void at(const SurfaceFrame& frame, std::vector<Section>& sections) const;

  // The place of a section at (a, b) of its disc; a^2 + b^2 = 1 is the surface of the cord.
  Vec3f place(const Section& section, float a, float b) const;

 private:
  struct Place {
    SurfaceId leaflet{};
    std::size_t valve = 0;
  };
  struct Hinge {
    Place of;
    std::uint32_t vertex = 0, before = 0, next = 0;  // of the leaflet, along its outline
  };
  void addHinge(const Place& leaflet, const SheetOutline& outline, const std::vector<bool>& hinged,
                const std::vector<Vec3f>& first_m);

  double radius_m_ = 0;
  std::vector<Hinge> hinges_;  // by section
  std::vector<Stretch> stretches_;
};

}  // namespace echocine
