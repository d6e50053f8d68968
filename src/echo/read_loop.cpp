#include "echo/read_loop.h"

// From a file to a loop with sector, scale and rate: the user's word first, then the picture's,
// then the file's.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/error.h"
#include "echo/beam_recording.h"
#include "echo/render_folder.h"
#include "video/read_video.h"

namespace echocine::echo {

namespace {

constexpr double kAspectNoted = 0.03, kAspectRefused = 0.12;  // our choice

// Pictures with pixels that are not square, stretched in height.
void makeSquare(Video& video, double aspect) {
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
      "pixels are {} times as high as wide, as given: the picture is stretched", aspect));
}

// A sector that was given is taken as it is, but has to lie in the picture; one that is found must
// not be stretched.
void findWhere(EchoLoop& loop, const SideOptions& side, bool is_real) {
  const char* option = is_real ? "--sector" : "--synthetic-sector";
  if (side.sector) {
    loop.find = {};
    loop.find.sector = parseSector(option, *side.sector);
    loop.find.given = true;
    const Sector& s = loop.find.sector;
    // Every fourth pixel each way: its area to some percent is enough.
    double inside = 0;
    for (int y = 0; y < loop.video.height; y += 4)
      for (int x = 0; x < loop.video.width; x += 4) inside += s.contains(x + 0.5, y + 0.5) ? 16 : 0;
    const double whole = 0.5 * (s.last_rad - s.first_rad) * (s.r_max * s.r_max - s.r_min * s.r_min);
    if (inside < 0.5 * whole)
      throw SceneError(fmt::format("{}: \"{}\" lies mostly outside the {} x {} picture of {}",
                                   option, *side.sector, loop.video.width, loop.video.height,
                                   loop.video.name));
    return;
  }
  loop.find = findSector(loop.video);
  const double off = std::abs(loop.find.aspect - 1);
  if (off > kAspectRefused && !side.pixel_aspect)
    throw SceneError(fmt::format(
        "{}: its sector is stretched, the lower edge fits pixels {:.2f} times as high as wide; "
        "give the "
        "loop in its true shape, or --{}pixel-aspect {:.2f}",
        loop.video.name, loop.find.aspect, is_real ? "" : "synthetic-", loop.find.aspect));
  if (off > kAspectNoted && !side.pixel_aspect)
    loop.video.notes.push_back(fmt::format(
        "the lower edge of its sector is not a circle around the apex: pixels may be {:.3f} times "
        "as "
        "high as "
        "wide (--{}pixel-aspect), or its lines start from a curved face; used unchanged",
        loop.find.aspect, is_real ? "" : "synthetic-"));
}

// Share of the sector that colour was laid over: masked, and the rest is compared.
void noteColour(EchoLoop& loop) {
  constexpr double kNoted = 0.03;
  double coloured = 0, inside = 0;
  for (int y = 0; y < loop.video.height; ++y)
    for (int x = 0; x < loop.video.width; ++x) {
      if (!loop.sector().contains(x + 0.5, y + 0.5)) continue;
      ++inside;
      coloured += loop.video.coloured[static_cast<std::size_t>(y * loop.video.width + x)];
    }
  if (coloured > kNoted * inside)
    loop.video.notes.push_back(
        fmt::format("colour covers {:.0f} % of its sector: masked, the rest is "
                    "compared",
                    100 * coloured / inside));
}

// Text around the sector may be a patient's name, so no output contains it.
void blankOutside(EchoLoop& loop) {
  constexpr double kMargin_px = 1.5;  // the edge's own pixels
  Sector kept = loop.sector();
  kept.r_min = std::max(0.0, kept.r_min - kMargin_px);
  kept.r_max += kMargin_px;
  const double margin_rad = kMargin_px / kept.r_max;
  kept.first_rad -= margin_rad;
  kept.last_rad += margin_rad;
  for (int y = 0; y < loop.video.height; ++y)
    for (int x = 0; x < loop.video.width; ++x) {
      if (kept.contains(x + 0.5, y + 0.5)) continue;
      const auto p = static_cast<std::size_t>(y) * static_cast<std::size_t>(loop.video.width) +
                     static_cast<std::size_t>(x);
      for (PixelPlane& frame : loop.video.frames) frame[p] = 0;
      loop.overlay[p] = 0;
      loop.video.coloured[p] = 0;
    }
}

// The user's word first, then the file's, then the picture's: before what is burnt in around the
// sector is blanked.
void anchorBeat(EchoLoop& loop, const SideOptions& side, bool folder, bool recording) {
  if (side.ed_frame || !side.r_waves_s.empty()) {
    loop.beat_anchor = "given";
  } else if (folder) {
    loop.beat_anchor = "manifest";
  } else if (recording) {
    return;  // its ECG is no picture
  } else if (!loop.video.r_waves_s.empty()) {
    loop.beat_anchor = "DICOM R waves";
  } else if (side.read_ecg) {
    loop.ecg = readEcg(loop.video, loop.sector());
    if (loop.ecg) loop.beat_anchor = "ECG in the picture";
  }
}

// Renders and recordings state these themselves, and their greys lie in them.
void refuseOfExact(const std::filesystem::path& path, const SideOptions& side, bool is_real) {
  const std::string prefix = is_real ? "--" : "--synthetic-";
  for (const auto& [given, option] : {std::pair(side.mm_per_pixel.has_value(), "scale"),
                                      {side.sector.has_value(), "sector"},
                                      {side.pixel_aspect.has_value(), "pixel-aspect"}})
    if (given)
      throw SceneError(fmt::format("{}{}: {} states its own scale and sector; omit the option",
                                   prefix, option, path.string()));
}

// Some scanners give the end behind the last pixel.
bool insidePicture(const UltrasoundRegion& r, const Video& v) {
  return r.max_x <= v.width && r.max_y <= v.height && r.min_x <= r.max_x && r.min_y <= r.max_y;
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

}  // namespace

void checkSide(const SideOptions& side) {
  const auto check = [](const char* name, const std::optional<double>& value, double least,
                        double most) {
    if (value && !(*value >= least && *value <= most))
      throw SceneError(
          fmt::format("{}: is {:g}, accepted: {:g} to {:g}", name, *value, least, most));
  };
  check("fps", side.fps, kLeastFrameRate_hz, kMostFrameRate_hz);
  check("mm_per_pixel", side.mm_per_pixel, kLeastScale_mm, kMostScale_mm);
  check("pixel_aspect", side.pixel_aspect, kLeastAspect, kMostAspect);
  check("heart_rate_bpm", side.heart_rate_bpm, kLeastHeartRate_bpm, kMostHeartRate_bpm);
  check("ed_frame", side.ed_frame, 0, kMostFrame);
  check("es_frame", side.es_frame, 0, kMostFrame);
  for (const double wave : side.r_waves_s) check("r_waves_s", wave, 0, kMostRWave_s);
  if (!areAscending(side.r_waves_s))
    throw SceneError("r_waves_s: are not in order, accepted: ascending times");
}

void checkScale(const EchoLoop& loop) {
  SideOptions side;
  if (loop.metres_per_pixel) side.mm_per_pixel = 1e3 * *loop.metres_per_pixel;
  checkSide(side);
}

// Order matters: pixels are made square before the sector is looked for, and the scale needs the
// sector.
EchoLoop readLoop(const std::filesystem::path& path, const SideOptions& side, bool is_real) {
  checkSide(side);
  const bool folder = isRenderFolder(path), recording = !folder && isBeamRecording(path);
  const bool exact = folder || recording;  // sector and scale are known
  if (exact) refuseOfExact(path, side, is_real);
  EchoLoop loop;
  if (folder) {
    loop = readRenderFolder(path);
  } else if (recording) {
    loop = readBeamRecording(path);
  } else {
    loop.video = readVideo(path);
    if (side.pixel_aspect) makeSquare(loop.video, *side.pixel_aspect);
  }
  Video& v = loop.video;
  loop.label = side.label.value_or(is_real ? "real loop" : "synthetic loop");
  if (side.fps) v.rate = {*side.fps, is_real ? "--fps" : "--synthetic-fps", true};
  if (side.heart_rate_bpm) {
    v.heart_rate_bpm = side.heart_rate_bpm;
    v.heart_rate_source = is_real ? "--heart-rate" : "--synthetic-heart-rate";
  }
  if (!side.r_waves_s.empty()) v.r_waves_s = side.r_waves_s;
  if (!exact) findWhere(loop, side, is_real);
  anchorBeat(loop, side, folder, recording);
  if (!exact) {
    loop.overlay = overlayMask(v, loop.sector());
    noteColour(loop);
    blankOutside(loop);
  }
  if (side.mm_per_pixel) {
    loop.metres_per_pixel = 1e-3 * *side.mm_per_pixel;
    loop.scale_source = is_real ? "--scale" : "--synthetic-scale";
  } else if (!exact) {
    scaleFromRegions(loop);
  }
  if (v.rate.hz > 0 && !v.rate.trusted)
    v.notes.push_back(
        fmt::format("{:.4g} frames/s is the container's playback rate, not used as the acquisition "
                    "rate; give the frame rate",
                    v.rate.hz));
  if (!v.repeats.empty()) {
    std::string list;
    for (const int r : v.repeats) list += fmt::format("{}{}", list.empty() ? "" : ", ", r);
    v.notes.push_back(
        fmt::format("frame{} {} repeat the previous one: excluded from means and fits",
                    v.repeats.size() == 1 ? "" : "s", list));
  }
  return loop;
}

}  // namespace echocine::echo
