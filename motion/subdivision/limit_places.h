#pragma once
// Where on its control face each vertex of a uniformly refined mesh lies. Only for the sources of
// this stage.

#include <opensubdiv/far/topologyRefiner.h>

#include <cstdint>
#include <vector>

#include "scene/triangle_mesh.h"

namespace echocine {

// Places at which the limit surface is to be evaluated, and who uses each.
struct LimitPlaces {
  struct Place {
    float u, v;            // of a triangle: its corners are (0, 0), (1, 0), (0, 1)
    std::uint32_t normal;  // the number that its normal gets
  };
  std::vector<std::vector<Place>> on_face;  // by control face
  std::vector<Triangle> corners;            // normals of each refined triangle's corners
  std::uint32_t normal_count = 0;
  bool split = false;  // some vertex has more than one normal
};

// Each vertex of the last level once, by its own number, and once more for every further face where
// an infinitely sharp crease or corner lets faces have different normals. Precondition: refined
// uniformly, or not at all.
LimitPlaces limitPlaces(const OpenSubdiv::Far::TopologyRefiner& refiner);

}  // namespace echocine
