// How far a model's frames are from a real loop, without files: the call an optimiser makes again
// and again. Build it with the project; run it as `discrepancy_example LOOP SCENE.toml`.

#include <cstdio>

#include "compare/compare.h"
#include "compare/discrepancy.h"
#include "core/parallel.h"
#include "scene/scene_reader.h"
#include "simulate/frame_maker.h"
#include "simulate/plan_loop.h"

using namespace echocine;

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  withThreads(0, [&] {
    const compare::Loop real = compare::readLoop(argv[1], {}, true);  // once
    const Scene scene = readScene(argv[2]);
    const compare::Discrepancy discrepancy(real,
                                           scene.probe);  // once: the loop on the probe's lines
    const MeshMotion motion(scene);                       // the model, again when it changes
    const LoopPlan plan = planLoop(scene, motion);
    FrameMaker maker(scene, plan, motion);
    const auto workspace = maker.workspace();
    maker.trace({}, *workspace);             // the first frame: end-diastole
    maker.picture(1e-4, *workspace, false);  // to grey in beam space, white at this intensity
    std::printf("%.4f\n", discrepancy(0, workspace->polar.signal));  // against real frame 0
  });
}
