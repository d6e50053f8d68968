#pragma once
// A loop ready to be compared: its pictures, where the sector lies in them, and what a pixel is.

#include <optional>

#include "echo/ecg_trace.h"
#include "echo/sector.h"
#include "video/video.h"

namespace echocine::echo {

// Greys in beam space as they were before scan conversion: 0 to 255, line-major.
struct TracedGreys {
  int lines = 0, samples = 0;
  double first_rad = 0, last_rad = 0, near_m = 0, far_m = 0;  // edges included; from the apex
  std::vector<std::vector<float>> frames;
};

struct EchoLoop {
  Video video;
  // Shown in pages and JSON: a file name may contain a patient's name. Messages use Video::name.
  std::string label = "loop";
  SectorFind find;
  PixelPlane overlay;                      // 1 where a pixel holds no echo
  std::optional<double> metres_per_pixel;  // nothing when neither file, image nor user tells
  std::string scale_source;                // "--scale", "DICOM regions", "manifest", ...
  std::string grey_source = "picture";     // or "EXR display.Y", "cine.avi"
  // What tells when beats start: "given", "DICOM R waves", "ECG in the picture", "manifest", or
  // "the picture itself".
  std::string beat_anchor = "the picture itself";
  std::optional<EcgTrace> ecg;  // where it is that
  // Of a render folder; empty otherwise.
  TracedGreys traced;  // where its EXR hold them, resample() takes them and not the picture's
  std::vector<double> phases;                                           // of the beat, per frame
  std::vector<std::pair<std::string, std::vector<double>>> volumes_ml;  // structure -> per frame
  std::string lv_cavity;  // of them, the left ventricle's cavity; empty: not known
  std::string scene_sha256;
  double frames_per_beat = 0;  // 0: not known

  const Sector& sector() const { return find.sector; }

  // R waves in frames, within the loop where they are read from the picture; empty where none are
  // known.
  std::vector<double> rWaveFrames() const {
    if (ecg) return rWavesWithin(*ecg, video.frameCount());
    std::vector<double> out;
    if (video.rate.hz > 0)
      for (const double s : video.r_waves_s) out.push_back(s * video.rate.hz);
    return out;
  }
};

}  // namespace echocine::echo
