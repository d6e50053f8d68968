#include "simulate/echo_shift.h"

#include "scene/scan_geometry.h"
#include "trace/trace_frame.h"

namespace echocine {

void measureEchoShifts(const FrameGeometry& geometry, const Probe& probe, TraceSettings settings,
                       std::vector<EchoShift>& shifts) {
  settings.refraction = true;
  settings.note_hits = true;
  settings.cell_echoes = false;
  std::vector<LineTrace> traces;
  walkLines(geometry, probe, settings, traces);
  for (int i = 0; i < probe.lines; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    for (const InterfaceHit& pass : traces[static_cast<std::size_t>(i)].hits) {
      if (!pass.seen) continue;
      const Vec3d to = pass.point - line.origin;
      const double metres = length(to - dot(to, line.direction) * line.direction);
      const double spacing = lineSpacing(probe, pass.path_m);
      // A single line has no neighbour: its image is as fine as its samples.
      shifts.push_back({metres, metres / (spacing > 0 ? spacing : probe.sampleSpacing())});
    }
  }
}

}  // namespace echocine
