#include "echo/pixel_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace echocine::echo {

namespace {

// Pictures with pixels that are not square, stretched in height. `source`: who states the aspect.
void makeSquare(Video& video, double aspect, const char* source) {
  const int height = static_cast<int>(std::lround(video.height * aspect));
  const auto stretch = [&](PixelPlane& plane, int how) {
    const cv::Mat in(video.height, video.width, CV_8U, plane.data());
    cv::Mat out;
    cv::resize(in, out, {video.width, height}, 0, 0, how);
    plane.assign(out.datastart, out.dataend);
  };
  for (PixelPlane& frame : video.frames) stretch(frame, cv::INTER_LINEAR);
  stretch(video.coloured, cv::INTER_NEAREST);
  video.height = height;
  const auto stretched = [&](int rows) { return static_cast<int>(std::lround(rows * aspect)); };
  for (UltrasoundRegion& region : video.regions) {
    region.min_y = stretched(region.min_y);
    region.max_y = stretched(region.max_y + 1) - 1;
    region.cm_per_pixel_y /= aspect;
  }
  video.notes.push_back(fmt::format(
      "pixels are {:.5g} times as high as wide, as {}: the picture is stretched", aspect, source));
}

// Some scanners give the end behind the last pixel.
bool insidePicture(const UltrasoundRegion& r, const Video& v) {
  return r.max_x <= v.width && r.max_y <= v.height && r.min_x <= r.max_x && r.min_y <= r.max_y;
}

// Height of a pixel over its width by the largest region of the picture with both sizes; 1 without
// one. Values that no scanner has are none.
double statedAspect(const Video& v) {
  double aspect = 1;
  std::int64_t largest = 0;
  for (const UltrasoundRegion& r : v.regions) {
    if (!(r.cm_per_pixel_x > 0 && r.cm_per_pixel_y > 0) || !insidePicture(r, v)) continue;
    const std::int64_t area =
        (std::int64_t{r.max_x} - r.min_x + 1) * (std::int64_t{r.max_y} - r.min_y + 1);
    const double stated = r.cm_per_pixel_y / r.cm_per_pixel_x;
    if (area <= largest || !(stated >= kLeastAspect && stated <= kMostAspect)) continue;
    largest = area;
    aspect = stated;
  }
  return aspect;
}

}  // namespace

void takeAspect(const SideOptions& side, Video& v) {
  if (side.pixel_aspect) return makeSquare(v, *side.pixel_aspect, "given");
  constexpr double kEqual = 0.005;  // a pixel in a radius of 200; our choice
  const double stated = statedAspect(v);
  if (std::abs(stated - 1) < kEqual) return;
  if (!side.sector) return makeSquare(v, stated, "its regions state");
  v.notes.push_back(fmt::format(
      "its regions state pixels {:.5g} times as high as wide, but the sector is given: the picture "
      "is not stretched",
      stated));
}

// The region that holds the sector has the size of a pixel. A region that extends outside the
// picture belongs to a picture of another size: the factor that shrinks its box onto the sector's
// box gives the true scale.
void scaleFromRegions(EchoLoop& loop) {
  const Sector& s = loop.sector();
  Video& v = loop.video;
  const double left = s.apex_x + s.r_max * std::sin(s.first_rad),
               right = s.apex_x + s.r_max * std::sin(s.last_rad);
  const double bottom = s.apex_y + s.r_max, middle = (left + right) / 2;
  for (const UltrasoundRegion& r : v.regions) {
    if (!(r.cm_per_pixel_x > 0) || !(r.cm_per_pixel_y > 0)) continue;
    double shrink = 1;
    if (!insidePicture(r, v)) {
      // Sizes come in whole ratios: try those that put the region around the sector.
      // In outer radii, our choice; factors are those between usual screen and picture sizes.
      double best_misfit = 0.25;
      shrink = 0;
      for (const double factor : {2.0, 1.5, 4.0 / 3, 1.25, 1.6, 1.875, 2.5, 3.0, 4.0}) {
        const double off =
            (std::abs((r.min_x + r.max_x) / 2.0 / factor - middle) +
             std::abs(r.max_y / factor - bottom) + std::max(0.0, r.max_x / factor - v.width) +
             std::max(0.0, r.max_y / factor - v.height)) /
            s.r_max;
        if (off < best_misfit) best_misfit = off, shrink = factor;
      }
      if (shrink > 0)
        v.notes.push_back(
            fmt::format("its region ({},{})-({},{}) reaches outside the {} x {} picture: the tags "
                        "are those of a picture "
                        "{:.3g} times as large; scale {:.5f} cm per pixel taken instead of {:.5f}",
                        r.min_x, r.min_y, r.max_x, r.max_y, v.width, v.height, shrink,
                        r.cm_per_pixel_y * shrink, r.cm_per_pixel_y));
      else
        v.notes.push_back(
            fmt::format("its region ({},{})-({},{}) reaches outside the {} x {} picture and fits "
                        "it at no size: its scale is not used",
                        r.min_x, r.min_y, r.max_x, r.max_y, v.width, v.height));
    } else if (!(r.min_x <= middle && middle <= r.max_x && r.min_y <= bottom &&
                 bottom <= r.max_y + 0.1 * s.r_max)) {
      continue;  // of another part of the picture: a trace, a spectrum
    }
    if (shrink == 0) continue;
    const double cm = std::sqrt(r.cm_per_pixel_x * r.cm_per_pixel_y) * shrink,
                 depth_cm = cm * s.r_max;
    // From a mouse's heart to more than a body.
    if (depth_cm < 2 || depth_cm > 40) {
      v.notes.push_back(
          fmt::format("its scale of {:.5f} cm per pixel makes the sector {:.1f} cm deep, which is "
                      "impossible for an echo: not used",
                      cm, depth_cm));
      continue;
    }
    loop.metres_per_pixel = 0.01 * cm;
    loop.scale_source =
        shrink == 1 ? "DICOM regions" : "DICOM regions, corrected to the picture's size";
    return;
  }
}

}  // namespace echocine::echo
