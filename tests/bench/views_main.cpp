// view_table [FAMILY]: which of eight views of a model lies nearest to a loop of each view, with
// its margin; the model is the same heart, and then a healthy one. One line per loop.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "compare/model_discrepancy.h"
#include "support/view_loops.h"

namespace echocine::bench {
namespace {

using namespace compare;
using namespace support;

std::vector<ModelLoop> modelsOf(const std::function<Scene(View)>& sceneFor) {
  std::vector<ModelLoop> models;
  for (const ViewName& name : viewNames()) {
    const Scene scene = sceneFor(name.view);
    models.push_back(modelLoop(scene, MeshMotion(scene), kFitFrames));
  }
  return models;
}

// Of all eight, right ones and margins.
struct Score {
  int right = 0, views = 0;
  double least = 2, sum = 0;
  void add(double margin) {
    ++views;
    right += margin > 0 ? 1 : 0;
    least = std::min(least, margin);
    sum += margin;
  }
};

void judge(const char* what, const ModelDiscrepancy& loop, const std::vector<ModelLoop>& models,
           std::size_t right, Score& score) {
  std::vector<PoseFound> found;
  for (const ModelLoop& model : models) found.push_back(loop.search(model));
  std::size_t next = right == 0 ? 1 : 0;
  for (std::size_t v = 0; v < found.size(); ++v)
    if (v != right && found[v].discrepancy < found[next].discrepancy) next = v;
  const double margin = found[next].discrepancy - found[right].discrepancy;
  score.add(margin);
  const auto terms = [&](std::size_t v) {
    const PoseFound& f = found[v];
    return fmt::format("{} {:.3f} (R {:.2f} B {:.2f} M {:.2f} c {:.2f})", viewNames()[v].key,
                       f.discrepancy, f.terms.region, f.terms.boundary, f.terms.motion,
                       f.terms.in_sight);
  };
  fmt::print("  {:<8} {:+.3f}  {}  next {}\n", what, margin, terms(right), terms(next));
  std::fflush(stdout);
}

void tell(const char* what, const Score& s) {
  fmt::print("{}: right view first in {} of {}, margin {:.3f} in the mean, {:.3f} at least\n", what,
             s.right, s.views, s.sum / std::max(1, s.views), s.least);
}

void run(const char* only) {
  const std::vector<ModelLoop> healthy =
      modelsOf([](View view) { return heart::heartScene(heart::parametersFrom({}), view, 20); });
  for (const Family family : kFamilies) {
    if (only != nullptr && std::strcmp(only, nameOf(family)) != 0) continue;
    const std::vector<ModelLoop> same = modelsOf([&](View view) { return sceneOf(family, view); });
    Score own, other;
    for (std::size_t v = 0; v < viewNames().size(); ++v) {
      const Loop loop =
          scannedLoop(sceneOf(family, viewNames()[v].view), 24, 11 + static_cast<int>(v));
      SideOptions side;
      side.ed_frame = 0;
      const ModelDiscrepancy discrepancy(loop, side, same[v]);
      fmt::print("{} {}\n", nameOf(family), viewNames()[v].key);
      judge("same", discrepancy, same, v, own);
      judge("healthy", discrepancy, healthy, v, other);
    }
    tell((std::string(nameOf(family)) + ", the same heart").c_str(), own);
    tell((std::string(nameOf(family)) + ", a healthy heart").c_str(), other);
  }
}

}  // namespace
}  // namespace echocine::bench

int main(int argc, char** argv) {
  echocine::withThreads(0, [&] { echocine::bench::run(argc > 1 ? argv[1] : nullptr); });
}
