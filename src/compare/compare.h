#pragma once
// The comparison in one call: two loops in, every estimate and metric out.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/calibration.h"
#include "compare/space_alignment.h"
#include "compare/time_alignment.h"
#include "core/monitor.h"
#include "echo/beat_length.h"
#include "echo/read_loop.h"
#include "metrics/frame_metrics.h"
#include "signal/picture.h"

namespace echocine::fit {
struct SceneFit;  // fit_report.h
}

namespace echocine::compare {

struct CompareOptions {
  std::filesystem::path synthetic, real;
  echo::SideOptions synthetic_side, real_side;
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

struct Comparison {
  echo::EchoLoop synthetic, real;
  echo::BeatLength synthetic_beat, real_beat;
  echo::BeamGrid grid;
  TimeAlignment time;
  SpaceAlignment space;
  GreyCurve curve;
  std::vector<FrameResult> frames;       // one per real frame
  FrameMetrics mean_before, mean_after;  // over counted frames
  std::vector<BandMetrics> mean_bands;
  double overlap = 1;  // c of discrepancy.h
  double discrepancy = 0;
  double discrepancy_as_placed = 0;  // before anything but the sectors was registered
  std::vector<std::string> notes;    // everything that was overridden, assumed or left out

  std::shared_ptr<const fit::SceneFit>
      scene_fit;  // with CompareOptions::scene, where it can be held

  echo::BeamLoop synthetic_beams, real_beams;  // on the common grid, registered
  std::vector<float> weights;                  // of its samples
};

// Throws SceneError (unusable input or option) and JobError, also when the monitor, which is asked
// between stages, wants to stop.
Comparison compareLoops(const CompareOptions& options, const Monitor& monitor = {});

}  // namespace echocine::compare
