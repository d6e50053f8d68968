#pragma once
// The comparison in one call: two loops in, every estimate and metric out.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/beat_length.h"
#include "compare/calibration.h"
#include "compare/loop.h"
#include "compare/space_alignment.h"
#include "compare/time_alignment.h"
#include "core/monitor.h"
#include "metrics/frame_metrics.h"
#include "signal/picture.h"

namespace echocine::compare {

// What a user may know better than the files. Frames count from 0.
struct SideOptions {
  std::optional<double> fps, mm_per_pixel, pixel_aspect, heart_rate_bpm;  // aspect: height / width
  std::optional<std::string> sector;
  std::optional<double> ed_frame, es_frame;  // may lie between two
  std::vector<double> r_waves_s;             // from the first frame
  bool read_ecg = true;                      // of the picture, where no R wave is known otherwise
};

struct CompareOptions {
  std::filesystem::path synthetic, real;
  SideOptions synthetic_side, real_side;
  bool align_space = true;
  bool monotone = false;
  int knot_count = 8;
  std::vector<double> knots;    // given: greys of the synthetic loop; empty: chosen
  std::filesystem::path scene;  // of the render folder: for bands about its
                                // boundaries, and for where it disagrees
  double tilt_deg = 0;          // by which the scene's plane may be tilted and rotated, either way
  double band_mm = 4;           // full width of a band; our choice
  bool contours = false;        // drawn in the pictures
};

// A band about one structure's boundary, or over all boundaries together ("all").
struct BandMetrics {
  std::string structure;
  FrameMetrics metrics;
};

struct FrameResult {
  int real_frame = 0;
  double real_time_s = 0;
  double synthetic_place = -1;  // frames; negative: the synthetic loop shows no such instant
  double synthetic_phase = -1;  // of the beat, when known
  bool repeat = false;          // of the real frame before: measured, but not in the loop's means
  FrameMetrics before, after;   // without and with grey calibration
  double discrepancy = 0;
  std::vector<BandMetrics> bands;  // with calibration
  bool counted() const { return synthetic_place >= 0 && !repeat; }
};

struct SceneFit;  // fit_where.h

struct Comparison {
  Loop synthetic, real;
  BeatLength synthetic_beat, real_beat;
  BeamGrid grid;
  TimeAlignment time;
  SpaceAlignment space;
  GreyCurve curve;
  std::vector<FrameResult> frames;       // one per real frame
  FrameMetrics mean_before, mean_after;  // over counted frames
  std::vector<BandMetrics> mean_bands;
  double share_in_sight = 1;  // c of discrepancy.h
  double discrepancy = 0;
  double discrepancy_as_placed = 0;  // before anything but the sectors was registered
  std::vector<std::string> notes;    // everything that was overridden, assumed or left out

  std::shared_ptr<const SceneFit> scene_fit;  // with CompareOptions::scene, where it can be held

  BeamLoop synthetic_beams, real_beams;  // on the common grid, registered
  std::vector<float> weights;            // of its samples
};

// Throws SceneError (unusable input or option) and JobError, also when the monitor, which is asked
// between stages, wants to stop.
Comparison compareLoops(const CompareOptions& options, const Monitor& monitor = {});

// A loop with its sector, scale and rate, from a render folder or any video.
Loop readLoop(const std::filesystem::path& path, const SideOptions& side, bool is_real);

}  // namespace echocine::compare
