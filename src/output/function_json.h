#pragma once
// Function of the heart over a loop, as JSON: truth/function.json and the manifest's curves.

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "output/frame_record.h"
#include "signal/picture.h"
#include "truth/frame_truth.h"

namespace echocine {

// Properties of a loop as a whole.
struct LoopTruth {
  std::span<const TruthMaker::Tracked> tracked;
  std::optional<ViewOffset> view;
  // A valve event of the left ventricle: phase, and its instant in the first beat of the loop, s.
  struct Event {
    const char* name;
    double phase, time_s;
  };
  std::vector<Event> events;
};

// records and frames: one per frame each.
nlohmann::ordered_json functionJson(std::span<const FrameRecord> records,
                                    std::span<const FunctionFrame> frames, const LoopTruth& loop,
                                    const PictureGeometry& picture);

// A name with its unit, if it has one, and one value per frame.
using Curve = std::pair<std::string, std::vector<double>>;
std::vector<Curve> functionCurves(std::span<const FunctionFrame> frames);

}  // namespace echocine
