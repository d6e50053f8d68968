#pragma once
// The tissue as the scatterers see it: its groups of motion, and the positions of the corners of
// a small cube of it at an instant. Positions within a cube are trilinear, which is exact for any
// affine motion and for the lattice of the motion field.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "core/box.h"
#include "core/vec3.h"

namespace echocine {

// Corner c of a cube: x, y, z at the high end where bits 0, 1, 2 of c are set.
using CubeCorners = std::array<Vec3f, 8>;

// Blocks of tissue at the reference phase. Within the cubes of their halves every group's places
// are trilinear, and some groups' within whole blocks.
struct CubeLattice {
  Vec3f origin_m;
  float block_m = 8e-3f;
};

// Tissue at one instant.
class MaterialFrame {
 public:
  virtual ~MaterialFrame() = default;
  virtual CubeCorners corners(std::uint16_t group, Vec3f low_m, float edge_m) const = 0;
  // Places of scatterers that stand on sheets, in the same order at every instant.
  virtual std::span<const Vec3f> onSheets() const { return {}; }
};

// Tissue moves less from any instant to the nearest of Material::overTheBeat().
inline constexpr float kBetweenInstants_m = 2e-3f;

class Material {
 public:
  virtual ~Material() = default;
  virtual CubeLattice lattice() const { return {}; }
  virtual bool blood(std::uint16_t /*group*/) const { return false; }
  // For tissue that is not the heart's: its renewal time over that of the surroundings. Else 0.
  virtual float surroundings(std::uint16_t /*group*/) const { return 0; }
  // Is the group trilinear within whole blocks?
  virtual bool coarse(std::uint16_t /*group*/) const { return false; }
  // Groups with places in the block that begins at low_m: all of them, perhaps more.
  virtual std::vector<std::uint16_t> groupsIn(Vec3f /*low_m*/) const { return {0}; }
  virtual void groupsAt(std::span<const Vec3f> reference_m, std::span<std::uint16_t> groups) const {
    for (std::size_t i = 0; i < reference_m.size(); ++i) groups[i] = 0;
  }
  // How strongly tissue scatters back, as factors of amplitude at reference places of one group;
  // asked for only where they differ.
  virtual bool differs() const { return false; }
  virtual void amplitudes(std::span<const Vec3f> /*reference_m*/, std::uint16_t /*group*/,
                          std::span<float> /*out*/) const {}
  // Calls look() for instants all over the beat. Never called: whatever may be seen is kept.
  virtual void overTheBeat(const std::function<void(const MaterialFrame&)>& /*look*/) const {}
  // The most that any tissue moves, from the reference: across the imaging plane and in it.
  virtual double reachAcross_m() const { return 0; }
  virtual double reachAlong_m() const { return 0; }
  // Displacements of a group in the block that begins at low_m, at the instants of overTheBeat().
  virtual Box movesOver(Vec3f /*low_m*/, std::uint16_t /*group*/) const {
    const Vec3d most{reachAlong_m(), reachAcross_m(), reachAlong_m()};
    return {-most, most};
  }
};

}  // namespace echocine
