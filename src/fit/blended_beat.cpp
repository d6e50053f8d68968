#include "fit/blended_beat.h"

#include <algorithm>

#include "core/parallel.h"
#include "motion/surfaces/probe_placement.h"

namespace echocine::fit {

BlendedBeat::BlendedBeat(std::span<const SurfaceModes> frames, std::span<const float> shares,
                         const PlaneTilt& tilt)
    : frames_(frames),
      shares_(shares.begin(), shares.end()),
      tilt_(tilt),
      pose_(turnedAndTilted({}, tilt.rotate_rad, tilt.tilt_rad)),
      sides_(frames.size()) {
  parallelBlocks(frames.size(), 1, [&](std::size_t f, std::size_t) {
    for (const SurfaceModes::Ball& ball : frames[f].balls(shares_)) {
      const auto y = static_cast<float>(pose_.fromWorld(toDouble(ball.middle_m)).y);
      sides_[f].push_back(y > ball.radius_m    ? Side::above
                          : y < -ball.radius_m ? Side::below
                                               : Side::near);
    }
  });
}

void BlendedBeat::frameAt(std::size_t number, SurfaceFrame& frame) const {
  const SurfaceModes& modes = frames_[number];
  // Pieces of the frame before take their motion from here.
  const std::vector<Side>&own = sides_[number],
        &before = sides_[(number + sides_.size() - 1) % sides_.size()];
  std::vector<char> wanted(own.size());
  for (std::size_t p = 0; p < own.size(); ++p)
    wanted[p] = own[p] == Side::near || before[p] == Side::near ? 1 : 0;
  modes.blend(shares_, wanted, frame);
  frame.near_plane.resize(frame.positions_m.size());
  for (std::vector<TriangleRange>& of_surface : frame.near_plane) of_surface.clear();
  const bool turned = tilt_.rotate_rad != 0 || tilt_.tilt_rad != 0;
  for (std::size_t p = 0; p < own.size(); ++p) {
    const SurfacePatch& patch = modes.patches()[p];
    std::vector<Vec3f>& positions_m = frame.positions_m[patch.surface];
    if (own[p] == Side::near) frame.near_plane[patch.surface].push_back(patch.triangles);
    if (wanted[p] == 0)
      std::fill(positions_m.begin() + patch.first, positions_m.begin() + patch.end,
                Vec3f{0, own[p] == Side::above ? 1.0f : -1.0f, 0});
    else if (turned)
      for (std::size_t v = patch.first; v < patch.end; ++v)
        positions_m[v] = toFloat(pose_.fromWorld(toDouble(positions_m[v])));
  }
}

}  // namespace echocine::fit
