#pragma once
// Labels at their positions in the picture, along sound paths instead of straight path lengths.

#include <cstdint>
#include <vector>

#include "geometry/sound_paths.h"
#include "scene/scene.h"
#include "truth/plane_labels.h"

namespace echocine {

class ShownLabels {
 public:
  // `paths` defines the directions of the paths.
  ShownLabels(const Scene& scene, const PictureGrid& grid, const SoundPaths& paths);

  // Every pixel's structure by the path nearest to it, rows from the top; 0 outside the scan area.
  void picture(const SoundPaths& paths, PlaneLabels::Ids& ids) const;

  // Every sample's structure, line-major.
  void samples(const SoundPaths& paths, std::vector<std::uint32_t>& ids) const;

 private:
  struct Pixel {
    std::uint32_t at, path;
    float depth_m;
  };
  Probe probe_;
  std::size_t pixel_count_;
  std::vector<Pixel> pixels_;  // those in the scan area
};

}  // namespace echocine
