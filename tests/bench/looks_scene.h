#pragma once
// Parametric hearts with a look, for the tables of looks.

#include <cstdint>
#include <string>
#include <vector>

#include "frame/simulator.h"
#include "motion/heart/parameters.h"
#include "scene/scene.h"

namespace echocine::bench {

struct LookHearts {
  int hearts = 12, first = 0;
  Look look = Look::scanner;
  Quality quality = Quality::medium;
  std::string view;        // of the table of greys; empty: all eight
  std::string save, with;  // folder of pictures; a scene file's [signal], [speckle], [artefacts]
};

// Dials spread evenly over healthy and ill adults: an additive sequence.
heart::Parameters parametersOf(int number);
// Replaces the look of a scene; its white stays.
void takeTables(const LookHearts& options, Scene& scene);
// Seeds of heart `number`.
void seedScene(int number, Scene& scene);

// Structures of the picture's pixels, from 1; 0: none.
std::vector<std::uint16_t> idsOf(const Simulator& simulator, double phase);
void savePgm(const std::string& path, const GreyImage& image);

}  // namespace echocine::bench
