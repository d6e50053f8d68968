#pragma once
// A loop in memory: the planes of all frames in order.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/monitor.h"
#include "frame/simulator.h"
#include "motion/cycle/frame_time.h"

namespace echocine {

// As requested by the scene; everything else is empty.
struct Loop {
  Scene scene;
  int frames = 0, lines = 0, samples = 0, width = 0, height = 0;
  std::vector<FrameTime> times;
  std::map<Channel, std::vector<float>> planes;       // T x lines x samples
  std::map<Channel, std::vector<std::uint32_t>> ids;  // the same for integers
  std::vector<float> greys;                           // T x lines x samples
  std::vector<std::uint8_t> images, labels;           // T x height x width
  // T x 3 x lines x samples: lateral, axial, elevation; mm and mm/s.
  std::vector<float> displacement_mm, velocity_mm_s;
  std::vector<float> velocity_beam_m_s;  // T x lines x samples: positive towards the probe
  std::vector<float> tracks_mm;          // T x N x 3: lateral, elevation, depth
  std::vector<std::uint8_t> track_layer, track_segment;                 // N
  std::vector<std::pair<std::string, std::vector<double>>> volumes_ml;  // structure -> T
  std::vector<FunctionFrame> function;                                  // T, if requested
  std::vector<std::vector<Contour>> contours;                           // T, if requested
  double reference_intensity = 1;
};

// Frames range.first to range.second - 1 on the given number of threads (0: one per core), with the
// same values as renderLoop(). Throws SceneError, JobError; JobError also when the monitor requests
// a stop.
Loop renderInMemory(const Simulator& simulator, std::pair<int, int> range,
                    const Monitor& monitor = {}, int threads = 0);

}  // namespace echocine
