#pragma once
// A surface as triangles in space, measured by area: results do not depend on how finely it is
// meshed.

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

using Facet = std::array<Vec3d, 3>;
using Facets = std::vector<Facet>;

double areaOf(const Facet& facet);

// Centre of a surface by area; the mean of the corners of one without area. Precondition: at least
// one facet.
Vec3d middleOf(std::span<const Facet> facets);

// The same surface with no edge over `edge`. Precondition: edge > 0.
Facets refined(std::span<const Facet> facets, double edge);

// Adds the part of a facet where a height is at least 0, given at its corners and linear between
// them.
void addPartAbove(const Facet& facet, const std::array<double, 3>& height, Facets& to);

// The part of a surface whose height is at least `least`. The height is exact at corners and linear
// between them.
Facets partAbove(std::span<const Facet> facets, const std::function<double(Vec3d)>& height,
                 double least);

// The second moments by area about `middle`: three rows of a symmetric matrix.
std::array<Vec3d, 3> momentsAbout(std::span<const Facet> facets, Vec3d middle);

// The distance of the farthest point from a place; 0 without facets.
double farthestFrom(std::span<const Facet> facets, Vec3d place);

}  // namespace echocine
