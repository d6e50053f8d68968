#pragma once
// Trabeculae: the rough inner surface of the ventricles, as a picture shows it. Muscle ridges stand
// into the cavity and blood lies between them. The meshes stay what they are: volumes, contours,
// labels and motion are those of the smooth surface, about which the relief has mean 0.

#include <cstdint>
#include <optional>
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

// A ventricle's relief. Its height is a normal field of the heart's own coordinates at phase 0, cut
// at TrabeculaeSettings::most_m(), no finer than two edges of the mesh. It fades where other blood
// is near, at valves and outflow, and stays so low that no face turns over at any of 16 phases.
struct Relief {
  SurfaceId surface{};
  std::vector<float> height_m;         // by vertex, into the cavity
  std::vector<std::uint32_t> moved{};  // vertices that are shown
  std::vector<Triangle> about{};       // all faces about them
};

class Trabeculae {
 public:
  // Of the scene's ventricles. everywhere: all vertices, else those about the imaging plane.
  Trabeculae(const Scene& scene, const MeshMotion& motion, bool everywhere);

  const std::vector<Relief>& reliefs() const { return reliefs_; }

  // A frame's smooth surfaces, kept while it shows the relief.
  struct Smooth {
    std::vector<std::vector<Vec3f>> positions_m;
  };
  // Moves vertices along the normals of this very frame; those of ventricles' walls that lie on
  // them at phase 0, as a wall's own inner side does, go along. Thread-safe.
  void raise(SurfaceFrame& frame, Smooth& smooth) const;
  // The frame as it was.
  void lower(SurfaceFrame& frame, Smooth& smooth) const;

 private:
  // A vertex that goes along with another one.
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
