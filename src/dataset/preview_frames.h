#pragma once
// One view of a heart at two instants, without truth, layouts and other frames.

#include "core/monitor.h"
#include "dataset/dataset_loop.h"

namespace echocine::dataset {

struct PreviewFrames {
  std::string id, population;
  View view = View::a4c;
  double edv_ml = 0, esv_ml = 0;
  GreyImage ed, es;
  Values values;
  int impossible = 0;  // draws before this one
};

// For the first possible draw, the one of makeHeart() unless frames of a loop fail. `view`: index
// in the spec. Throws SceneError if every draw was impossible, JobError if the monitor stops.
PreviewFrames previewFramesOf(const Spec& spec, int heart, std::size_t view,
                              const Monitor& monitor);

}  // namespace echocine::dataset
