#include "fit/view_check.h"

#include "core/error.h"
#include "fit/coverage.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/recording.h"

namespace echocine::fit {

namespace {

double pictureValue(const ModelDiscrepancy& discrepancy, const ModelLoop& model,
                    const PoseFound& found) {
  return pictureDiscrepancy(found.discrepancy, coverageOf(model, discrepancy.stack(), found.pose));
}

}  // namespace

std::optional<ViewRival> betterView(const std::map<std::string, double>& dials, heart::View named,
                                    const ModelDiscrepancy& discrepancy, const ModelLoop& own,
                                    const FitPose& pose, const Monitor& monitor) {
  const heart::Parameters parameters = heart::parametersFrom(dials);
  const heart::ParametricHeart model(parameters);
  const heart::Recording beat =
      heart::recordBeat(model, named, kFitFrames, heart::KeyframeSpacing::even, monitor);
  ViewRival out{named, pictureValue(discrepancy, own, discrepancy.at(own, pose)), 1};
  for (const heart::View view :
       {heart::View::a4c, heart::View::a2c, heart::View::a3c, heart::View::plax}) {
    if (view == named) continue;
    if (!monitor.keep_going()) throw JobError("stopped while a heart was fitted");
    heart::Recording recording = beat;
    recording.pose = heart::poseOf(view, recording);
    heart::surround(view, recording.pose, model, recording);
    const Scene scene = heart::sceneOf(view, parameters, recording);
    const MeshMotion motion(scene);
    const ModelLoop loop = modelLoop(scene, motion, kFitFrames);
    const double value = pictureValue(discrepancy, loop, discrepancy.search(loop));
    if (value < out.other) out.view = view, out.other = value;
  }
  return out.other < out.own ? std::optional(out) : std::nullopt;
}

}  // namespace echocine::fit
