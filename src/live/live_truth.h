#pragma once
// Ground truth of a picture, for display over it.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "frame/simulator.h"
#include "truth/frame_truth.h"

namespace echocine::live {

// Not thread-safe: as LiveRenderer.
class LiveTruth {
 public:
  // Labels and contours at their positions in the picture. With `wall`, also material points of the
  // left ventricle's wall and its function, and a line of reason if the scene has none. `still` is
  // the simulator of the picture, `name` identifies its scene. Throws SceneError if the frame is
  // not in the loop.
  struct Layers {
    FrameTruth truth;
    std::vector<Vec3f> first_tracks_m;  // the same points in frame 0
    const TruthMaker* maker = nullptr;  // for segments of the tracks, and the view
    std::string no_wall;                // why there is no wall
  };
  Layers at(const Simulator& still, const std::string& name, int frame, bool wall);

  // A body for the page: a JSON header with its length as 4 bytes before it, little endian, and
  // with `labels` 16-bit structures of the pixels, from 1, 0 outside.
  static std::string bytes(const Layers& layers, const Scene& scene, int frame, bool labels);

 private:
  void prepare(const Simulator& still, const std::string& name, bool wall);

  std::string name_, no_wall_;
  bool wall_ = false;
  std::unique_ptr<const Simulator> simulator_;
  std::vector<Vec3f> first_tracks_m_;
};

}  // namespace echocine::live
