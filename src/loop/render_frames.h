#pragma once
// One loop: its white is measured once, then every frame goes into a sink.

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "core/monitor.h"
#include "frame/simulator.h"

namespace echocine {

struct Workspace;

// A frame on its way into a sink, which may move out of it what it keeps.
struct MadeFrame {
  FrameTime time;
  Workspace& workspace;             // channels, greys and picture
  Volumes volumes_ml;               // of closed structures, by name
  std::optional<FrameTruth> truth;  // as far as the scene and the sink ask
};

// Where the frames of a loop go.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  // Once, before the first frame, with the loop's white (relative to I_S).
  virtual void begin(double /*white*/) {}

  // Whether take() reads the frames' truth; without it none is made.
  virtual bool wantsTruth() const { return true; }

  // From several threads at once. Returns what has to be handled in order, or nullptr.
  virtual std::shared_ptr<void> take(MadeFrame& frame) = 0;

  // What take() returned: one call at a time, in the order of the frames.
  virtual void inOrder(void* /*taken*/) {}
};

// Makes the frames first up to, without, last of the loop, as many at once as the enclosing
// withThreads() allows, and returns how many. There are fewer when monitor.keep_going() says no;
// begin() is not called if it does so while white is measured. Frames that were traced for white
// are not traced again. Throws what the simulator and the sink throw.
int renderFrames(const Simulator& simulator, std::pair<int, int> range, FrameSink& sink,
                 const Monitor& monitor);

// The same of any instants, against a given white; begin() is not called.
int renderFrames(const Simulator& simulator, std::span<const FrameTime> times, double white,
                 FrameSink& sink, const Monitor& monitor);

}  // namespace echocine
