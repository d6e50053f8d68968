// import echocine._echocine: scenes, frames, loops and comparisons as arrays.

#include "python/bindings.h"
#include "python/fork_guard.h"
#include "python/unlocked.h"

PYBIND11_MODULE(_echocine, module) {
  using namespace echocine::python;
  module.doc() = "The compiled part of echocine; use the package's own names.";
  module.attr("__version__") = ECHOCINE_VERSION;
  watchForks();
  watchTheEnd();
  bindErrors(module);
  bindMeshes(module);
  bindScene(module);
  bindFrame(module);
  bindSimulator(module);
  bindLoop(module);
  bindRender(module);
  bindModes(module);
  bindPlan(module);
  bindCompare(module);
  bindModels(module);
  bindFit(module);
  bindHeartFit(module);
  bindDataset(module);
  bindFiles(module);
  bindLive(module);
}
