#pragma once
#include "scene/scene.h"
#include "truth/frame_truth.h"

namespace echocine {

// The pixels of the scene's picture, for sampling truth.
PictureGrid pictureGrid(const Scene& scene);

}  // namespace echocine
