#pragma once
#include "scene/scene.h"
#include "truth/frame_truth.h"

namespace echocine {

// The pixels of the scene's picture, as truth is sampled on them.
PictureGrid pictureGrid(const Scene& scene);

}  // namespace echocine
