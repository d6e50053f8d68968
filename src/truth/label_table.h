#pragma once
// Labels of structures in the label pictures.

#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace echocine {

struct LabelTable {
  std::vector<std::uint8_t> numbers;  // by structure; 0: no label of its own
  struct Entry {
    std::uint8_t number;
    std::string name;
  };
  std::vector<Entry> entries;  // ascending numbers; 0 is the background and outside the sector
};

// Numbers of truth.labels; without it, closed structures are numbered from 1 in the scene's order.
// Throws SceneError if more than 8 bits are needed.
LabelTable labelTable(const Scene& scene);

}  // namespace echocine
