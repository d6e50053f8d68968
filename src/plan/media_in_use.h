#pragma once
// The media of a scene, and whether they differ.

#include <vector>

#include "scene/scene.h"

namespace echocine {

// The background first, then that of each structure, with repetitions. They live as long as the
// scene.
std::vector<const Medium*> mediaInUse(const Scene& scene);

// Do any two differ in a property that the tracer uses, or in sound speed?
bool mediaDiffer(const Scene& scene);
bool speedsDiffer(const Scene& scene);

// Is the medium filled with air? Density below 700 kg/m^3: our choice, between lung and fat.
bool isAirFilled(const Medium& medium);
// Is any medium in use filled with air?
bool holdsAir(const Scene& scene);

}  // namespace echocine
