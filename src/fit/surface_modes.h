#pragma once
// The surfaces of many hearts at one frame of their beats, as few modes: a mean, and principal
// components. A heart between them is a blend of the modes.

#include <cstdint>
#include <span>
#include <vector>

#include "fit/surface_patches.h"

namespace echocine::fit {

class SurfaceModes {
 public:
  // hearts: the same surfaces of each heart. kept: the vertices that the patches number, by
  // surface. Principal components with a root mean square over hearts and vertices below 2
  // micrometres are omitted. at_places: the shares of all hearts in the blend at the place of each
  // heart; empty: this heart alone. A polynomial of least squares does not pass through its hearts,
  // and its blends need fewer modes than they.
  SurfaceModes(std::span<const SurfaceFrame* const> hearts,
               const std::vector<std::vector<std::uint32_t>>& kept, SurfacePatches patches,
               const std::vector<std::vector<double>>& at_places = {});

  // The sum of all hearts, each by its share. Precondition: one share per heart; the sum is 1. With
  // at_places, shares are those of the same polynomial.
  SurfaceFrame blend(std::span<const float> shares) const;

  // The same for the vertices of the wanted patches. Others stay as they are in the frame.
  void blend(std::span<const float> shares, std::span<const char> wanted,
             SurfaceFrame& frame) const;

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
  // Coordinates of a patch's vertices in a mode, in steps. A blend is limited by the memory that it
  // reads: a third of that of floats.
  struct Term {
    std::uint32_t mode;
    float step_m;
  };
  struct Part {
    std::size_t shapes;              // its first coordinates
    std::size_t first, narrow, end;  // its terms: coordinates of 16 bits, then of 10
  };
  std::vector<std::uint32_t> shapes_;  // two or three coordinates in each
  std::vector<Term> terms_;
  std::vector<Part> parts_;  // by patch
  Blocks middles_m_;
  Blocks radii_m_;  // farthest of the touched vertices from the middle
};

}  // namespace echocine::fit
