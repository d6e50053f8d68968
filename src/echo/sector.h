#pragma once
// The scan area in a picture.

#include <string>
#include <vector>

#include "video/video.h"

namespace echocine::echo {

// Pixels; pixel (i, j) covers i..i+1, j..j+1. Angles from straight down, positive to the right.
struct Sector {
  double apex_x = 0, apex_y = 0;       // pixels
  double first_rad = 0, last_rad = 0;  // left and right edge
  double r_min = 0, r_max = 0;         // pixels from the apex

  bool contains(double x, double y) const;
};

struct SectorFind {
  Sector sector;
  double edge_inliers = 1;  // share of rows whose first and last live pixels lie on the edges
  double aspect = 1;        // pixel height / width, from the lower arc; 1 if undetermined
  bool given = false;
  std::vector<std::string> notes;
  double confidence() const { return edge_inliers; }
};

// The sector of pixels that move or are not black: the largest grey level of each pixel over the
// loop, the largest connected part, straight lines through its outermost pixels (RANSAC, then least
// squares), their intersection, and the radii between which arcs are live. Throws SceneError if
// there is none. A stretched sector is reported by its aspect.
SectorFind findSector(const Video& video);

// "apex_x,apex_y,first_deg,last_deg,r_min,r_max". Throws SceneError naming the option.
Sector parseSector(const std::string& option, const std::string& text);

// Pixels of the sector without echo: colour, and static text over the picture. Throws SceneError if
// colour covers more than 60 % of the sector (a Doppler box).
PixelPlane overlayMask(const Video& video, const Sector& sector);

}  // namespace echocine::echo
