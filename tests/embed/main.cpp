// A caller of the library: a parametric heart without any file, and a scene file where one is
// named.

#include <cstdio>
#include <exception>

#include <echocine/echocine.h>

int main(int argc, char** argv) try {
  using namespace echocine;
  heart::Parameters dials;
  dials.ejection_fraction = 0.45;
  Scene scene = argc > 1 ? readScene(argv[1]) : heart::heartScene(dials, heart::View::a4c, 8);
  scene.probe.lines = 64;
  scene.probe.samples = 128;
  const Simulator simulator(scene);          // reads or takes the meshes, plans the loop
  const Frame frame = simulator.frame(0.2);  // seconds
  double sum = 0;
  for (const float grey : frame.greys) sum += grey;
  std::printf("%zu greys, mean %.4f\n", frame.greys.size(),
              sum / static_cast<double>(frame.greys.size()));
  return sum > 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
