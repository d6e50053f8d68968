#pragma once
// Media and losses of contour clips, from the hits of the lines at the same place.

#include "scene/scan_geometry.h"
#include "trace/edge_clips.h"
#include "trace/hit_table.h"
#include "trace/interface_lanes.h"
#include "trace/trace_settings.h"

namespace echocine {

// Data of each clip, at the same row index.
struct InterfaceRows {
  ClipRow<std::int64_t> seen;         // -1; or 0, with nothing in the others
  ClipRow<std::uint32_t> ends;        // 1: total reflection ended the line there; else 0
  ClipRow<double> Z_1, Z_2, r, turn;  // of the media in front and behind; r and turn: SpeedRatio
  ClipRow<double> passed;             // prod (1-R)^2 before it times the gain
  ClipRow<double> lobe, membrane;     // n of cos^n; 1 or 0
  ClipRow<float> coherent_part;       // SurfaceTraits
  ClipRow<double> wave_along, wave_across, wave_out;  // InterfaceHit::wave
  ClipRow<double> path_m, depth_m, path_per_depth, exponent, exponent_per_path;  // InterfaceHit
};

class ClipInterfaces {
 public:
  // Preconditions: the lines contain hits, and all arguments outlive this.
  ClipInterfaces(const Probe& probe, const TraceSettings& settings,
                 std::span<const LineTrace> lines);

  // Finds the data of all clips of the edges. A clip on which the path length has a minimum becomes
  // two; the second is placed after all others. normals: of each edge, or empty for facet normals;
  // the clips use them.
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
