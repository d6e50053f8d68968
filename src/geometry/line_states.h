#pragma once
// Reduces the crossings of a line to those that change the state of a closed surface.

#include <vector>

#include "geometry/crossing.h"

namespace echocine {

// By distance; ties by surface, then by triangle, for a unique order.
inline bool nearer(const Crossing& a, const Crossing& b) {
  if (a.distance_m != b.distance_m) return a.distance_m < b.distance_m;
  if (a.surface != b.surface) return a.surface < b.surface;
  return a.triangle < b.triangle;
}

// Sorts by nearer() and removes duplicates: a triangle is crossed once.
void putInOrder(std::vector<Crossing>& crossings);

// Entries minus exits of every closed surface; out has an entry per surface.
void balances(const std::vector<Crossing>& crossings, std::vector<int>& out);

// Do the states of the closed surfaces alternate along the line, from those at its start to outside
// of all? Then every crossing changes a state, and entries and exits balance. Precondition: sorted
// by nearer().
bool statesAlternate(const std::vector<Crossing>& crossings, InsideSet inside,
                     const InsideSet& membranes);

// Removes crossings of closed surfaces that do not change whether the line is inside: those of a
// self-overlapping surface, and tangential contacts. depth[s]: number of times that the start is
// inside surface s (consumed). Surfaces in `clamped` have inconsistent counts; their states must at
// least alternate. Precondition: sorted by nearer().
void keepChanges(std::vector<Crossing>& crossings, std::vector<int>& depth,
                 const InsideSet& membranes, const InsideSet& clamped);

}  // namespace echocine
