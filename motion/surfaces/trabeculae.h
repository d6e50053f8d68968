#pragma once
// Trabeculae: the rough inner surface of the ventricles, for the picture and its echoes only.
// Muscle ridges extend into the cavity, with blood between them. The meshes are unchanged: volumes,
// contours, labels and motion are those of the smooth surface, about which the relief has mean 0.

#include <cstdint>
#include <optional>
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

// A ventricle's relief. Its height is a normal field of the heart's coordinates at phase 0, limited
// to TrabeculaeSettings::most_m() and no finer than two edges of the mesh. It fades near other
// blood, at valves and outflow, and is limited so that no face is inverted at any of 16 phases.
struct Relief {
  SurfaceId surface{};
  std::vector<float> height_m;         // by vertex, into the cavity
  std::vector<std::uint32_t> moved{};  // displaced vertices
  std::vector<Triangle> about{};       // all faces around them
};

class Trabeculae {
 public:
  // For the scene's ventricles. everywhere: all vertices; otherwise those near the imaging plane.
  Trabeculae(const Scene& scene, const MeshMotion& motion, bool everywhere);

  const std::vector<Relief>& reliefs() const { return reliefs_; }

  // A frame's smooth surfaces, stored while it shows the relief.
  struct Smooth {
    std::vector<std::vector<Vec3f>> positions_m;
  };
  // Displaces vertices along this frame's normals. Vertices of ventricular walls that coincide with
  // them at phase 0 follow. Thread-safe.
  void raise(SurfaceFrame& frame, Smooth& smooth) const;
  // Restores the frame.
  void lower(SurfaceFrame& frame, Smooth& smooth) const;

 private:
  // A vertex that follows another one.
  struct Follower {
    std::uint32_t vertex, leader;
    std::size_t relief;
  };
  struct Followers {
    std::size_t surface;
    std::vector<Follower> list;
  };

  void follow(const Scene& scene, const SurfaceFrame& frame, const MeshMotion& motion);

  std::vector<Relief> reliefs_;
  std::vector<Followers> followers_;
};

}  // namespace echocine
