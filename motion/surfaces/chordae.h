#pragma once
// Chordae tendineae between papillary muscles and mitral leaflets: thin strands that follow the
// meshes at both ends. They are in the picture only; no mesh and no truth contains them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

class Chordae {
 public:
  // Points of a chord's middle line, from the muscle to the leaflet.
  static constexpr std::size_t kPoints = 7;

  struct Chord {
    SurfaceId muscle{}, leaflet{};
    std::uint32_t origin = 0, insertion = 0;  // vertices of these
    double length_m = 0;                      // at rest: the largest distance of its ends
  };

  // Up to ten for each mitral leaflet of the scene. They insert at the free edge and the rough zone
  // beside it, evenly spread: vertices with 60 % or more of the leaflet's largest displacement. In
  // a leaflet that does not move relative to its hinge, these are the vertices nearest to the
  // muscles. Each begins at the vertex of a papillary muscle that is nearest to its insertion over
  // the beat.
  Chordae(const Scene& scene, const MeshMotion& motion);

  const std::vector<Chord>& chords() const { return chords_; }

  // kPoints points for each chord at an instant, probe frame, m. While the valve is closed chords
  // are straight: the muscles take up what they are too long. As it opens, a chord whose ends are
  // closer than its length sags outwards from the valve's middle; with the valve fully open, as a
  // parabola of that length. The sag is at most 0.15 of the distance of its ends. Precondition:
  // `frame` is one of the motion. Thread-safe.
  void at(const SurfaceFrame& frame, std::vector<Vec3f>& points_m) const;

 private:
  void attach(const Scene& scene, const std::vector<SurfaceFrame>& frames, SurfaceId leaflet,
              const std::vector<std::uint32_t>& insertions);

  std::vector<Chord> chords_;
  double closed_m_ = 0, open_m_ = 0;  // RMS distance of the insertions from their middle
};

}  // namespace echocine
