// What a simulator knows to be true of its frames.

#include <algorithm>

#include "frame/picture_grid.h"
#include "frame/simulator.h"

namespace echocine {

std::vector<KeyframeVolume> Simulator::keyframeVolumes() const {
  std::vector<KeyframeVolume> list;
  std::map<double, Volumes> by_phase;  // structures mostly share their phases
  SurfaceFrame surfaces;
  for (const Structure& structure : scene_.structures) {
    if (structure.membrane) continue;
    for (const Keyframe& keyframe : structure.keyframes) {
      Volumes& all = by_phase[keyframe.phase];
      if (all.empty()) {
        motion_->frameAt(keyframe.phase, surfaces);
        all = volumes(surfaces);
      }
      for (const auto& [name, ml] : all)
        if (name == structure.name) list.push_back({name, keyframe.phase, ml});
    }
  }
  return list;
}

const TruthMaker* Simulator::truth() const {
  std::call_once(truth_once_, [this] {
    if (TruthMaker::wanted(scene_))
      truth_ = std::make_unique<const TruthMaker>(scene_, *motion_, pictureGrid(scene_),
                                                  cardiac_clock_.at(0).phase);
  });
  return truth_.get();
}

// Velocity is taken from a millisecond before to one after, within the loop; rolling lines may
// begin a little before it.
FrameTruth Simulator::truthOf(const FrameTime& time, const TruthShared& shared,
                              bool planes_only) const {
  constexpr double kStep_s = 1e-3;
  const double end_s = cardiac_clock_.frameCount() / scene_.acquisition.frame_rate_hz;
  const double before_s = std::max(time.time_s - kStep_s, std::min(time.time_s, 0.0)),
               after_s = std::min(time.time_s + kStep_s, end_s);
  return truth()->at({time.phase, cardiac_clock_.atTime(before_s).phase,
                      cardiac_clock_.atTime(after_s).phase, after_s - before_s, planes_only},
                     shared);
}

// Of rolling lines what stands at samples and pixels is that of each line's instant; the rest is
// that of the frame's time.
FrameTruth Simulator::truthAt(const FrameTime& time, const Workspace* traced) const {
  TruthShared shared;
  if (traced != nullptr && traced->phase == time.phase) {
    shared.surfaces = &traced->surfaces;
    if (plan_.left_out.none() && !trabeculae_)
      shared.slice = std::get_if<PlaneSlice>(&traced->geometry);
  }
  FrameTruth truth = truthOf(time, shared, false);
  for (std::size_t g = 0; rolling_ && g < rolling_->groups().size(); ++g)
    rolling_->take(g, truthOf(timeOf(time.time_s + rolling_->groups()[g].offset_s), {}, true),
                   truth);
  return truth;
}

}  // namespace echocine
