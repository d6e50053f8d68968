#pragma once
// The place where two surfaces meet.

#include <span>

#include "motion/views/facets.h"

namespace echocine {

// Contact of two surfaces: the centre of the parts of both whose distance to the other is at most
// the smallest distance plus `margin`; and that smallest distance, from the corners of both.
// Preconditions: neither is empty.
struct Contact {
  Vec3d middle;
  double gap = 0;
};
Contact contactOf(std::span<const Facet> a, std::span<const Facet> b, double margin);

}  // namespace echocine
