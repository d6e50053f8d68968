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
  std::vector<double> knots;    // given: synthetic grey levels; empty: chosen
  std::filesystem::path scene;  // of the render folder: for bands around its
                                // boundaries, and for the scene fit
  double tilt_deg = 0;          // limit of tilt and rotation of the scene's plane, either way
  double band_mm = 4;           // full width of a band; our choice
  bool contours = false;        // draw the scene's contours into the pictures
};

// A band around one structure's boundary, or around all boundaries together ("all").
struct BandMetrics {
  std::string structure;
  FrameMetrics metrics;
};

struct FrameResult {
  int real_frame = 0;
  double real_time_s = 0;
  double synthetic_place = -1;  // frames; negative: the synthetic loop does not show this instant
  double synthetic_phase = -1;  // of the beat, if known
  bool repeat = false;         // repeats the previous real frame: measured, but excluded from means
  FrameMetrics before, after;  // without and with grey calibration
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
  double discrepancy_as_placed = 0;  // after registration of the sectors only
  std::vector<std::string> notes;    // everything that was overridden, assumed or omitted

  std::shared_ptr<const fit::SceneFit>
      scene_fit;  // with CompareOptions::scene, if a comparison is possible

  echo::BeamLoop synthetic_beams, real_beams;  // on the common grid, registered
  std::vector<float> weights;                  // of its samples
};

// Throws SceneError for unusable input or options, and JobError, also when the monitor requests a
// stop. It is polled between stages.
Comparison compareLoops(const CompareOptions& options, const Monitor& monitor = {});

}  // namespace echocine::compare
