// make_keyframes OUT_DIR: writes the beating heart's keyframes as OBJ files.

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "examples/beating_heart/heart_keyframes.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_keyframes OUT_DIR\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  for (const auto& keyframe : echocine::beating_heart::heartKeyframes()) {
    std::ofstream file(folder / keyframe.name, std::ios::binary);
    file << keyframe.text;
    file.close();
    if (file) continue;
    std::fprintf(stderr, "make_keyframes: cannot write %s\n", (folder / keyframe.name).c_str());
    return 1;
  }
  return 0;
}
