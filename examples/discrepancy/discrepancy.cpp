// How far a model's frames are from a real loop, without files: the call an optimiser makes again
// and again. Build it with the project; run it as `discrepancy_example LOOP SCENE.toml`.

#include <cstdio>
#include <exception>

#include "compare/compare.h"
#include "compare/frame_discrepancy.h"
#include "core/parallel.h"
#include "frame/simulator.h"
#include "scene/scene_reader.h"

using namespace echocine;

int main(int argc, char** argv) try {
  if (argc != 3) return 2;
  withThreads(0, [&] {
    const echo::EchoLoop real = echo::readLoop(argv[1], {}, true);  // once
    const Scene scene = readScene(argv[2]);
    const compare::FrameDiscrepancy discrepancy(
        real, scene.probe);                              // once: the loop on the probe's lines
    const Simulator simulator(scene);                    // the model, again when it changes
    const Frame frame = simulator.frame(0);              // end-diastole
    std::printf("%.4f\n", discrepancy(0, frame.greys));  // against real frame 0
  });
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
