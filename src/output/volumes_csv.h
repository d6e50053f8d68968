#pragma once
// volumes.csv: a loop's volumes and strains as a table for spreadsheets.

#include <string>

#include "output/manifest.h"
#include "scene/scene.h"

namespace echocine {

// Has the scene a chamber: a closed structure of blood?
bool hasChambers(const Scene& scene);

// One row per frame: frame, time_s, phase, beat, a column NAME_ml for each chamber, and of a loop
// with functional truth the longitudinal strains: global, of the view, and of the view's segments.
// Values are those of the manifest, to the last digit; undefined ones are empty.
std::string volumesCsv(const Scene& scene, const Manifest& manifest);

}  // namespace echocine
