#pragma once
// From all crossings of a line to those that change the state of a closed surface.

#include <vector>

#include "geometry/crossing.h"

namespace echocine {

// By distance; ties by surface, then by triangle, so that the order is the same everywhere.
inline bool nearer(const Crossing& a, const Crossing& b) {
  if (a.distance_m != b.distance_m) return a.distance_m < b.distance_m;
  if (a.surface != b.surface) return a.surface < b.surface;
  return a.triangle < b.triangle;
}

// Sorts by nearer() and drops what stands there twice: a triangle is crossed once.
void putInOrder(std::vector<Crossing>& crossings);

// Entries less exits of every closed surface; out has an entry per surface.
void balances(const std::vector<Crossing>& crossings, std::vector<int>& out);

// Do the states of the closed surfaces alternate along the line, from those at its start to outside
// of all? Then every crossing changes a state, and entries and exits balance. Precondition: sorted
// by nearer().
bool statesAlternate(const std::vector<Crossing>& crossings, InsideSet inside,
                     const InsideSet& membranes);

// Removes the crossings of closed surfaces that do not change whether the line is inside: those of
// a surface that overlaps itself, and contacts without passage. depth[s]: how often the start is
// inside surface s (consumed). Surfaces in `clamped` have counts that cannot be right; their states
// must at least alternate. Precondition: sorted by nearer().
void keepChanges(std::vector<Crossing>& crossings, std::vector<int>& depth,
                 const InsideSet& membranes, const InsideSet& clamped);

}  // namespace echocine
