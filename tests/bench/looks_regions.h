#pragma once
// Regions of a loop that were placed by hand, measured alike on real and on simulated loops.

#include <string>

namespace echocine::bench {

// Prints grey, deviation, cell and correlation over frames of each region of a CSV file
// (region,near_mm,far_mm,first_deg,last_deg,frame). `loop` is a scene, or a video whose pixels are
// so large. With `save` the first frame in beam space goes there, 0.25 mm by 0.25 degrees a pixel.
void printRegions(const std::string& regions, const std::string& loop, double mm_per_pixel,
                  const std::string& save);

}  // namespace echocine::bench
