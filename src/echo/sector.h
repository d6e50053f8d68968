#pragma once
// Where the scan area lies in a picture.

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
  double edge_inliers = 1;  // share of rows whose first and last live pixel lie on the edges
  double aspect = 1;  // height of a pixel over its width by the lower arc; 1 when it cannot tell
  bool given = false;
  std::vector<std::string> notes;
  double confidence() const { return edge_inliers; }
};

// The sector of what moves or is not black: for every pixel the largest grey over the loop, the
// largest connected part of it, straight lines through its outermost pixels (RANSAC, then least
// squares), their meeting point, and the radii between which arcs are live. Throws SceneError when
// there is none. One that is stretched says so by its aspect.
SectorFind findSector(const Video& video);

// "apex_x,apex_y,first_deg,last_deg,r_min,r_max". Throws SceneError naming the option.
Sector parseSector(const std::string& option, const std::string& text);

// Pixels of the sector that hold no echo: colour and text that stands still over the picture.
// Throws SceneError when colour covers more than 60 % of the sector (a Doppler box).
PixelPlane overlayMask(const Video& video, const Sector& sector);

}  // namespace echocine::echo
