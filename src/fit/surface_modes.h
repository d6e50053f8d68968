#pragma once
// The surfaces of many hearts at one frame of their beats, as few modes: a mean, and principal
// components. A heart between them is a blend of the modes.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fit/plane_tilt.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine::fit {

// Sorts vertices along a Z-order curve through their places, each once: neighbours in the list lie
// near each other.
void orderByPlace(std::span<const Vec3f> places_m, std::vector<std::uint32_t>& vertices);

// Successive vertices of a surface, which lie near each other.
struct SurfacePatch {
  std::size_t surface;
  std::uint32_t first, end;
  std::vector<std::uint32_t> touched;  // its own, and the other corners of their triangles
};
using SurfacePatches = std::shared_ptr<const std::vector<SurfacePatch>>;
SurfacePatches patchesOf(std::span<const SurfaceTopology> surfaces);

class SurfaceModes {
 public:
  // hearts: the same surfaces of each heart. kept: the vertices that the patches number, by
  // surface. Principal components with a root mean square over hearts and vertices below 2
  // micrometres are omitted.
  SurfaceModes(std::span<const SurfaceFrame* const> hearts,
               const std::vector<std::vector<std::uint32_t>>& kept, SurfacePatches patches);

  // The sum of all hearts, each by its share. Precondition: one share per heart; the sum is 1.
  SurfaceFrame blend(std::span<const float> shares) const;

  // Whether the plane y = 0 may cut a patch (near), otherwise its side.
  enum class Side : std::int8_t { below, near, above };
  // The same, of the patches near the plane. Vertices of the others lie 1 m away on their side.
  SurfaceFrame blend(std::span<const float> shares, std::span<const Side> sides) const;

  // The middle of a patch, and a radius about it that no touched vertex leaves.
  struct Ball {
    Vec3f middle_m;
    float radius_m;
  };
  std::vector<Ball> balls(std::span<const float> shares) const;
  const std::vector<SurfacePatch>& patches() const { return *patches_; }
  std::size_t count() const { return count_; }

 private:
  // Numbers as blocks of eight: those of the mean, then of each mode. A sum reads them in order.
  using Blocks = std::vector<float>;
  template <typename At>
  Blocks blocksOf(std::size_t numbers, const At& at) const;
  std::vector<float> factorsOf(std::span<const float> shares) const;
  void sum(const Blocks& blocks, std::span<const float> factors, std::span<float> out) const;
  void addPatch(const SurfacePatch& patch, std::span<const Vec3f> shapes_m);
  void blendPatch(std::size_t patch, std::span<const float> factors,
                  std::vector<Vec3f>& out_m) const;

  SurfacePatches patches_;
  std::size_t count_ = 0;                    // of modes
  std::vector<double> mode_of_heart_;        // count_ per heart
  std::vector<std::vector<Vec3f>> means_m_;  // by surface
  // By patch and mode: the coordinates of its vertices in steps, and the size of a step. A blend is
  // limited by the memory that it reads: half as much as with floats.
  std::vector<std::uint32_t> shapes_;  // two coordinates of 16 bits in each
  std::vector<float> steps_m_;
  Blocks middles_m_;
  Blocks radii_m_;  // farthest of the touched vertices from the middle
};

// A beat of a blend of hearts, in the frame of a tilted probe; frames: in their order in time, with
// the same patches. Vertices are correct where a triangle crosses the plane in this frame or in the
// one before. Others may lie elsewhere on their side of it.
std::vector<SurfaceFrame> blendNearPlane(std::span<const SurfaceModes> frames,
                                         std::span<const float> shares, const PlaneTilt& tilt);

}  // namespace echocine::fit
