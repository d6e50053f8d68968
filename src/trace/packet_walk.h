#pragma once
// Rays traced together through the hierarchy.

#include <span>

#include "core/work_counts.h"
#include "geometry/frame_geometry.h"
#include "trace/line_trace.h"
#include "trace/trace_settings.h"

namespace echocine {

inline constexpr std::size_t kPacket = 16;

// A ray with the closed surfaces that contain its origin. Path lengths count from start_m along it;
// crossings before that are ignored.
struct StartedRay {
  Ray ray;
  InsideSet inside;
  double start_m = 0;
};

// Traces up to kPacket rays through the media, one round per straight segment; traces[i] belongs to
// rays[i]. Neighbouring rays are fastest.
WorkCounts walkTogether(const FrameGeometry& geometry, const TraceSettings& settings,
                        std::span<const StartedRay> rays, std::span<LineTrace> traces);

}  // namespace echocine
