#include "motion/surfaces/leaflet_share.h"

#include <algorithm>

namespace echocine {

std::vector<SurfaceFrame> instantsOfBeat(const MeshMotion& motion,
                                         std::span<const SurfaceId> some) {
  constexpr int kInstants = 16;
  std::vector<SurfaceFrame> frames(kInstants);
  for (int i = 0; i < kInstants; ++i)
    motion.positionsAt(static_cast<double>(i) / kInstants, some,
                       frames[static_cast<std::size_t>(i)]);
  return frames;
}

std::vector<float> shareOfMotion(const std::vector<SurfaceFrame>& instants, std::size_t surface) {
  const std::vector<Vec3f>& first = instants.front().positions_m[surface];
  std::vector<float> share(first.size(), 0);
  for (const SurfaceFrame& frame : instants)
    for (std::size_t v = 0; v < share.size(); ++v)
      share[v] = std::max(share[v], length(frame.positions_m[surface][v] - first[v]));
  if (share.empty()) return share;
  const auto [least, most] = std::minmax_element(share.begin(), share.end());
  const float low_m = *least, range_m = *most - *least;
  for (float& s : share) s = range_m > 1e-3f ? (s - low_m) / range_m : 0;
  return share;
}

}  // namespace echocine
