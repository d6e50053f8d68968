#pragma once
// Rays that go through the hierarchy together.

#include <span>

#include "core/work_counts.h"
#include "geometry/frame_geometry.h"
#include "trace/line_trace.h"
#include "trace/trace_settings.h"

namespace echocine {

inline constexpr std::size_t kPacket = 16;

// A ray with the closed surfaces that hold its origin; path lengths count from start_m along it,
// and what it meets before is no interface.
struct StartedRay {
  Ray ray;
  InsideSet inside;
  double start_m = 0;
};

// Follows up to kPacket rays through the media, one round per straight edge; traces[i] is that of
// rays[i]. Neighbouring rays cost least.
WorkCounts walkTogether(const FrameGeometry& geometry, const TraceSettings& settings,
                        std::span<const StartedRay> rays, std::span<LineTrace> traces);

}  // namespace echocine
