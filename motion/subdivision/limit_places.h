#pragma once
// Position of each vertex of a uniformly refined mesh on its control face. Only for the sources of
// this room.

#include <opensubdiv/far/topologyRefiner.h>

#include <cstdint>
#include <vector>

#include "scene/triangle_mesh.h"

namespace echocine {

// Places at which the limit surface is evaluated, and their users.
struct LimitPlaces {
  struct Place {
    float u, v;            // of a triangle: its corners are (0, 0), (1, 0), (0, 1)
    std::uint32_t normal;  // index of its normal
  };
  std::vector<std::vector<Place>> on_face;  // by control face
  std::vector<Triangle> corners;            // normals of each refined triangle's corners
  std::uint32_t normal_count = 0;
  bool split = false;  // some vertex has more than one normal
};

// Each vertex of the last level once, by its own index, and again for every further face if an
// infinitely sharp crease or corner separates normals. Precondition: refined uniformly, or not at
// all.
LimitPlaces limitPlaces(const OpenSubdiv::Far::TopologyRefiner& refiner);

}  // namespace echocine
