#pragma once
// What the lines themselves met where a clip of contour is: the media and losses that it takes
// over.

#include "scene/scan_geometry.h"
#include "trace/edge_clips.h"
#include "trace/hit_table.h"
#include "trace/interface_lanes.h"
#include "trace/trace_settings.h"

namespace echocine {

// Of each clip, in the same places of the rows.
struct InterfaceRows {
  ClipRow<std::int64_t> seen;         // -1; or 0, with nothing in the others
  ClipRow<std::uint32_t> ends;        // 1: total reflection ended the line there; else 0
  ClipRow<double> Z_1, Z_2, r, turn;  // of the media before and behind; r and turn: SpeedRatio
  ClipRow<double> passed;             // prod (1-R)^2 before it times the gain
  ClipRow<double> lobe, membrane;     // n of cos^n; 1 or 0
  ClipRow<float> coherent_part;       // SurfaceTraits
  ClipRow<double> wave_along, wave_across, wave_out;  // InterfaceHit::wave
  ClipRow<double> path_m, depth_m, path_per_depth, exponent, exponent_per_path;  // InterfaceHit
};

class ClipInterfaces {
 public:
  // Preconditions: the lines hold hits, and all arguments outlive this.
  ClipInterfaces(const Probe& probe, const TraceSettings& settings,
                 std::span<const LineTrace> lines);

  // Of all clips of the edges. Clips on which the path length turns round become two, the second
  // of which stands behind all others. normals: of each edge, or none where the facets' own count;
  // the clips take them over.
  void find(std::span<const ContourEdge> edges, std::span<const EdgeNormals> normals,
            EdgeClips& clips, InterfaceRows& rows) const;

 private:
  const InterfaceHit* besideTheLine(const ContourEdge& edge, const EdgeClips& clips,
                                    std::size_t i) const;
  void takeOver(const InterfaceHit* hit, InterfaceRows& rows, std::size_t clip) const;

  const ScanGeometry geometry_;
  int lines_;
  const TraceSettings& settings_;
  HitTable table_;
  std::vector<SpeedRatio> speeds_;  // from each medium to each, by the first
};

}  // namespace echocine
