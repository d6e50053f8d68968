#pragma once
// One view of a heart at two instants: no truth, no layouts, no other frames.

#include "core/monitor.h"
#include "dataset/dataset_loop.h"

namespace echocine::dataset {

struct PreviewFrames {
  std::string id, population;
  View view = View::a4c;
  double edv_ml = 0, esv_ml = 0;
  GreyImage ed, es;
  Values values;
  int impossible = 0;  // draws before it
};

// Of the first draw that is possible, the same as makeHeart() takes as far as no frame of a loop
// is impossible. `view` counts the spec's. Throws SceneError where every draw was impossible,
// JobError where the monitor stops.
PreviewFrames previewFramesOf(const Spec& spec, int heart, std::size_t view,
                              const Monitor& monitor);

}  // namespace echocine::dataset
