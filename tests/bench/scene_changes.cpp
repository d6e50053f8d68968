// A scene that changes for every frame, in C++: the floor of python_calls.py. Prints CPU
// milliseconds a frame. scene_changes FRAMES

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "bench/cpu_time.h"
#include "core/units.h"
#include "echocine/echocine.h"

namespace {

using namespace echocine;

// The ejection fraction and the probe's place move with i, as they do in python_calls.py.
void frameOf(int i) {
  const heart::Parameters dials = heart::parametersFrom({{"ef", 0.40 + 0.002 * (i % 50)}});
  Scene scene = heart::heartScene(dials, heart::View::a4c, 12, Look::paper);
  scene.probe.pose.origin.y = metresFromMillimetres(0.1 * (i % 50));
  const Simulator simulator(std::move(scene));
  const Frame frame = simulator.frame(0.1);
  if (frame.greys.values.empty()) std::abort();
}

}  // namespace

int main(int argc, char** argv) try {
  const int frames = argc == 2 ? std::atoi(argv[1]) : 0;
  if (frames < 1) return 2;
  frameOf(0);
  const double all_ms = bench::millisecondsOf([&] {
    for (int i = 0; i < frames; ++i) frameOf(i);
  });
  std::printf("%.3f\n", all_ms / frames);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
