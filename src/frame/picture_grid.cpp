#include "frame/picture_grid.h"

#include "signal/picture.h"

namespace echocine {

PictureGrid pictureGrid(const Scene& scene) {
  const PictureGeometry g = pictureGeometry(scene);
  return {scene.output.width, scene.output.height, g.origin_x_px, g.origin_y_px,
          g.metres_per_pixel};
}

}  // namespace echocine
