#pragma once
// Blocks of tissue that beams reach at some instant of the beat, found before any scatterer is
// drawn.

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "speckle/beam_view.h"
#include "speckle/material.h"
#include "speckle/point_spread.h"

namespace echocine {

// One group in a block. Scatterers of a cube are kept or left out together: the halves of a block
// along each axis are its cubes, numbered with bit 0 for the high end of x, 1 of y, 2 of z. The
// block of a coarse group is one cube, number 0.
struct BlockPart {
  std::uint16_t group = 0;
  std::uint8_t seen = 0;  // by cube: bit c is set if a beam reaches cube c at some instant
};

struct TissueBlock {
  Vec3f low_m;
  float edge_m = 0;
  std::uint64_t pattern = 0;  // hash of the seed and of the block's place on the lattice
  double wanted = 0;          // scatterers, not rounded
  std::vector<BlockPart> parts;

  // Does a beam reach this cube of any group?
  bool seesHalf(std::uint32_t half, const Material& material) const;
  // Does a beam reach this cube of the group?
  bool sees(std::uint16_t group, std::uint32_t cube) const;
};

// The low corner of a cube with this edge, relative to its block's.
Vec3f cubeOffset(std::uint32_t cube, float edge_m);
// The number of the half that holds a place, in the numbering of BlockPart.
std::uint32_t halfOf(const TissueBlock& block, Vec3f place_m);

// Blocks with at least one visible cube, in the order of the lattice. Each cube is tested at every
// instant of Material::overTheBeat(). Throws SceneError if blocks or scatterers exceed the memory
// limit.
std::vector<TissueBlock> searchBlocks(const Probe& probe, const PointSpread& spread,
                                      const BeamView& view, const SpeckleSettings& settings,
                                      const Material& material);

}  // namespace echocine
