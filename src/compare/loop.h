#pragma once
// A loop ready to be compared: its pictures, where the sector lies in them, and what a pixel is.

#include <optional>

#include "compare/sector.h"
#include "compare/video.h"

namespace echocine::compare {

struct Loop {
  Video video;
  SectorFind find;
  Plane overlay;                           // 1 where a pixel holds no echo
  std::optional<double> metres_per_pixel;  // nothing when neither file, image nor user tells
  std::string scale_source;                // "--scale", "DICOM regions", "manifest", ...
  // Of a render folder; empty otherwise.
  std::vector<double> phases;                                           // of the beat, per frame
  std::vector<std::pair<std::string, std::vector<double>>> volumes_ml;  // structure -> per frame
  std::string scene_sha256;
  double frames_per_beat = 0;  // 0: not known

  const Sector& sector() const { return find.sector; }
};

}  // namespace echocine::compare
