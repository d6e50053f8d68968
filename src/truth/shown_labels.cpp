#include "truth/shown_labels.h"

#include <algorithm>
#include <cmath>

namespace echocine {

ShownLabels::ShownLabels(const Scene& scene, const PictureGrid& grid, const SoundPaths& paths)
    : probe_(scene.probe),
      pixel_count_(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height)) {
  if (!scene.truth.labels) return;
  const ScanGeometry geometry(paths.probe);
  std::uint32_t at = 0;
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column, ++at) {
      const double x = grid.xOf(column), z = grid.zOf(row);
      if (!inScanArea(probe_, x, z)) continue;
      const auto place = geometry.beamPosition(x, z);  // nothing where all lines are one
      const int path = place ? geometry.nearestLine(place->line) : 0;
      pixels_.push_back(
          {at, static_cast<std::uint32_t>(path), static_cast<float>(geometry.pathOf({x, 0, z}))});
    }
}

void ShownLabels::picture(const SoundPaths& paths, PlaneLabels::Ids& ids) const {
  ids.assign(pixel_count_, 0);
  for (const Pixel& pixel : pixels_)
    ids[pixel.at] = paths.paths[pixel.path].idAt(static_cast<double>(pixel.depth_m));
}

void ShownLabels::samples(const SoundPaths& paths, std::vector<std::uint32_t>& ids) const {
  const auto count = static_cast<std::size_t>(probe_.samples);
  ids.clear();
  ids.reserve(static_cast<std::size_t>(probe_.lines) * count);
  const ScanGeometry geometry(probe_);
  for (std::size_t i = 0; i < static_cast<std::size_t>(probe_.lines); ++i) {
    const SoundPath& path = paths.paths[paths.pathOfLine(i)];
    for (std::size_t k = 0; k < count; ++k)
      ids.push_back(path.idAt(geometry.sampleDepth(static_cast<int>(k))));
  }
}

}  // namespace echocine
