#pragma once
// How the heart works over a loop, as JSON: truth/function.json and the manifest's curves.

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "output/frame_record.h"
#include "signal/picture.h"
#include "truth/frame_truth.h"

namespace echocine {

// What holds for a loop as a whole.
struct LoopTruth {
  std::span<const TruthMaker::Tracked> tracked;
  std::optional<ViewOffset> view;
  // Valves of the left ventricle by name: phase, and the instant of the loop's first beat, s.
  struct Event {
    const char* name;
    double phase, time_s;
  };
  std::vector<Event> events;
};

// records and frames: one of each per frame.
nlohmann::ordered_json functionJson(std::span<const FrameRecord> records,
                                    std::span<const FunctionFrame> frames, const LoopTruth& loop,
                                    const PictureGeometry& picture);

// A name, with its unit where it has one, and a value per frame.
using Curve = std::pair<std::string, std::vector<double>>;
std::vector<Curve> functionCurves(std::span<const FunctionFrame> frames);

}  // namespace echocine
