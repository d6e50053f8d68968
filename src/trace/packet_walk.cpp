#include "trace/packet_walk.h"

#include <array>
#include <optional>

#include "core/check.h"
#include "trace/line_walker.h"

namespace echocine {

WorkCounts walkTogether(const FrameGeometry& geometry, const TraceSettings& settings,
                        std::span<const StartedRay> rays, std::span<LineTrace> traces) {
  DCHECK_LE(rays.size(), kPacket);
  std::array<std::optional<LineWalker>, kPacket> walkers;
  thread_local std::array<RayQuery, kPacket> queries;  // their memory is used again
  thread_local std::array<RayCrossings, kPacket> met;
  WorkCounts work;
  for (std::size_t i = 0; i < rays.size(); ++i)
    walkers[i].emplace(settings, rays[i].ray, rays[i].inside, traces[i], rays[i].start_m);
  for (;;) {
    std::array<std::size_t, kPacket> who{};
    std::size_t alive = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (walkers[i]->alive()) {
        who[alive] = i;
        queries[alive++] = walkers[i]->query();
      }
    if (alive == 0) return work;
    geometry.crossings(std::span(queries).first(alive), std::span(met).first(alive));
    work.rays += alive;
    for (std::size_t i = 0; i < alive; ++i) {
      work.crossings += met[i].crossings.size();
      walkers[who[i]]->advance(met[i]);
    }
  }
}

}  // namespace echocine
