#pragma once
// One loop: white is measured once, then every frame is passed to a sink.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/monitor.h"
#include "frame/simulator.h"

namespace echocine {

struct Workspace;

// A rendered frame for a sink, which may move data out of it.
struct MadeFrame {
  FrameTime time;
  Workspace& workspace;             // channels, greys and picture
  Volumes volumes_ml;               // of closed structures, by name
  std::optional<FrameTruth> truth;  // as far as the scene and the sink ask
};

// Destination of the frames of a loop.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  // Once, before the first frame, with the loop's white (relative to I_S).
  virtual void begin(double /*white*/) {}

  // Whether take() reads the frames' truth; without it none is made.
  virtual bool wantsTruth() const { return true; }

  // Receives the intensities of a frame before the signal chain, as Making::received; none by
  // default. Called from several threads, not for frames that were traced for white.
  virtual std::function<void(Intensities&)> receiver(const FrameTime& /*time*/) { return {}; }

  // Called from several threads. Returns data to be handled in order, or nullptr.
  virtual std::shared_ptr<void> take(MadeFrame& frame) = 0;

  // Receives the results of take(), one call at a time, in the order of the frames.
  virtual void inOrder(void* /*taken*/) {}
};

// Renders the frames first to last - 1 of the loop, as many at once as the enclosing withThreads()
// allows, and returns their number. It is smaller if monitor.keep_going() becomes false or a
// checkpoint stops a frame; if that happens during the measurement of white, begin() is not called.
// Frames traced for white are not traced again. Throws what the simulator and the sink throw.
int renderFrames(const Simulator& simulator, std::pair<int, int> range, FrameSink& sink,
                 const Monitor& monitor);

// The same for any instants, with a given white; begin() is not called.
int renderFrames(const Simulator& simulator, std::span<const FrameTime> times, double white,
                 FrameSink& sink, const Monitor& monitor);

}  // namespace echocine
