#include "echo/read_loop.h"

// From a file to a loop with sector, scale and rate: the user's word first, then the picture's,
// then the file's.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "echo/beam_recording.h"
#include "echo/pixel_size.h"
#include "echo/render_folder.h"
#include "video/read_video.h"

namespace echocine::echo {

namespace {

constexpr double kAspectNoted = 0.03, kAspectRefused = 0.12;  // our choice

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
  const bool has_waves = !loop.video.r_waves_s.empty() && loop.video.rate.hz > 0;
  if (side.ed_frame || (has_waves && !side.r_waves_s.empty())) {
    loop.beat_anchor = "given";
  } else if (folder) {
    loop.beat_anchor = "manifest";
  } else if (recording) {
    return;  // its ECG is no picture
  } else if (has_waves) {
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

// Times and rates are frames only with a frame rate.
void noteUnusedTimes(EchoLoop& loop) {
  Video& v = loop.video;
  if (!v.r_waves_s.empty() && !(v.rate.hz > 0))
    v.notes.emplace_back("its R waves are not used, because the frame rate is unknown: give it");
  if (v.heart_rate_bpm && !v.rate.trusted && !(loop.frames_per_beat > 0))
    v.notes.push_back(
        fmt::format("the heart rate ({}) is not used, because the frame rate of the acquisition is "
                    "unknown: give it",
                    v.heart_rate_source));
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
    takeAspect(side, loop.video);
  }
  Video& v = loop.video;
  loop.label = side.label.value_or(is_real ? "real loop" : "synthetic loop");
  if (side.fps) {
    if (v.r_waves_by_frames)  // stay at their frames
      for (double& wave_s : v.r_waves_s) wave_s *= v.rate.hz / *side.fps;
    v.rate = {*side.fps, is_real ? "--fps" : "--synthetic-fps", true};
  }
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
  noteUnusedTimes(loop);
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
