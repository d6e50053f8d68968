// A frame in memory by the frame's library alone; frame_libraries_test.cmake looks at what it
// loads.
//   frame_program scene.toml

#include <cstdio>

#include "frame/simulator.h"
#include "scene/scene_reader.h"

int main(int, char** arguments) {
  const echocine::Simulator simulator(echocine::readScene(arguments[1]));
  const echocine::Frame frame = simulator.frame(0);
  std::printf("%d x %d\n", frame.image.width, frame.image.height);
  return frame.image.pixels.empty() ? 1 : 0;
}
