#pragma once
// What the lines themselves met where a part of contour is: the media and losses that it takes
// over.

#include "trace/cell_parts.h"
#include "trace/interface_lanes.h"
#include "trace/pass_table.h"
#include "trace/trace_settings.h"

namespace echocine {

// Of each part, in the same places of the rows.
struct InterfaceRows {
  PartRow<std::int64_t> seen;         // -1; or 0, with nothing in the others
  PartRow<double> Z_1, Z_2, r, turn;  // of the media before and behind; r and turn: SpeedRatio
  PartRow<double> passed;             // prod (1-R)^2 before it times the gain
  PartRow<double> lobe, membrane;     // n of cos^n; 1 or 0
  PartRow<double> path_m, depth_m, path_per_depth, exponent, exponent_per_path;  // InterfacePass
};

class PartInterfaces {
 public:
  // Preconditions: the lines hold passes, and all arguments outlive this.
  PartInterfaces(const Probe& probe, const TraceSettings& settings,
                 std::span<const LineTrace> lines);

  // Of all parts of the pieces. Parts on which the path length turns round become two, the second
  // of which stands behind all others. normals: of each piece, or none where the facets' own count;
  // the parts take them over.
  void find(std::span<const ContourPiece> pieces, std::span<const PieceNormals> normals,
            CellParts& parts, InterfaceRows& rows) const;

 private:
  void takeOver(const InterfacePass* pass, InterfaceRows& rows, std::size_t part) const;

  const Probe& probe_;
  const TraceSettings& settings_;
  PassTable table_;
  std::vector<SpeedRatio> speeds_;  // from each medium to each, by the first
};

}  // namespace echocine
