#pragma once
// A beat of a heart between computed ones, in the frame of a tilted probe, as far as its plane
// needs it.

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "fit/plane_tilt.h"
#include "fit/surface_modes.h"

namespace echocine::fit {

class BlendedBeat {
 public:
  // frames: in their order in time, with the same patches; they are kept by reference. shares: as
  // for SurfaceModes::blend().
  BlendedBeat(std::span<const SurfaceModes> frames, std::span<const float> shares,
              const PlaneTilt& tilt);

  // Replaces a frame by one with near_plane. Vertices are correct where a triangle crosses the
  // plane in this frame or in the one before. Others may lie elsewhere on their side of it.
  // Thread-safe.
  void frameAt(std::size_t number, SurfaceFrame& frame) const;

 private:
  std::span<const SurfaceModes> frames_;
  std::vector<float> shares_;
  PlaneTilt tilt_;
  Pose pose_;
  enum class Side : std::int8_t { below, near, above };  // near: the plane may cut the patch
  std::vector<std::vector<Side>> sides_;                 // by frame and patch
};

}  // namespace echocine::fit
