#pragma once
// A loop ready for comparison: its pictures, sector and scale.

#include <optional>

#include "echo/ecg_trace.h"
#include "echo/sector.h"
#include "video/video.h"

namespace echocine::echo {

// Grey levels in beam space before scan conversion: 0 to 255, line-major.
struct TracedGreys {
  int lines = 0, samples = 0;
  double first_rad = 0, last_rad = 0, near_m = 0, far_m = 0;  // edges included; from the apex
  std::vector<std::vector<float>> frames;
};

struct EchoLoop {
  Video video;
  // Name in pages and JSON, because a file name may contain a patient's name. Messages use
  // Video::name.
  std::string label = "loop";
  SectorFind find;
  PixelPlane overlay;                      // 1 for pixels without echo
  std::optional<double> metres_per_pixel;  // none if neither file, image nor user gives it
  std::string scale_source;                // "--scale", "DICOM regions", "manifest", ...
  std::string grey_source = "picture";     // or "EXR display.Y", "cine.avi"
  // Source of the start of beats: "given", "DICOM R waves", "ECG in the picture", "manifest", or
  // "the picture itself".
  std::string beat_anchor = "the picture itself";
  std::optional<EcgTrace> ecg;  // if it is the source
  // For a render folder; empty otherwise.
  TracedGreys traced;  // if its EXR have them; resample() then uses these, not the picture's
  std::vector<double> phases;                                           // of the beat, per frame
  std::vector<std::pair<std::string, std::vector<double>>> volumes_ml;  // structure -> per frame
  std::string lv_cavity;  // name of the left ventricle's cavity among them; empty: unknown
  std::string scene_sha256;
  double frames_per_beat = 0;  // 0: unknown

  const Sector& sector() const { return find.sector; }

  // R waves in frames, within the loop if they are read from the picture; empty if unknown.
  std::vector<double> rWaveFrames() const {
    if (ecg) return rWavesWithin(*ecg, video.frameCount());
    std::vector<double> out;
    if (video.rate.hz > 0)
      for (const double s : video.r_waves_s) out.push_back(s * video.rate.hz);
    return out;
  }
};

}  // namespace echocine::echo
