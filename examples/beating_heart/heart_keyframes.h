#pragma once
// The beating heart as files.

#include <string>
#include <vector>

namespace echocine::beating_heart {

inline constexpr int kKeyframes = 20;  // evenly spaced over the beat, the first at end-diastole

struct KeyframeFile {
  std::string name;  // such as lv_cavity_00.obj
  std::string text;  // Wavefront OBJ, coordinates in cm
};

// The keyframes of every structure: control meshes for two levels of Loop subdivision.
std::vector<KeyframeFile> heartKeyframes();

}  // namespace echocine::beating_heart
