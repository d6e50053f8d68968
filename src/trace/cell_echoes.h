#pragma once
// The echo of an interface integrated over the beam's cell, the half-way angles (or places) to both
// neighbouring lines, instead of sampled at the line's centre. The contour between lines is known,
// so this costs no ray. A wall that runs along the beam then comes out as a line and not as a
// string of beads.

#include <span>
#include <vector>

#include "geometry/plane_slice.h"
#include "trace/line_trace.h"
#include "trace/trace_settings.h"

namespace echocine {

// Fills `echoes` with what the contour inside each line's cell sends back: for each edge of
// contour its lobe at its own angle of incidence, spread over the samples it spans by the share of
// the cell it covers in each. Media and losses before it are those of the cell's line where it
// hits the same surface, nearest in depth. For a flat interface the sum over lines is what
// sampling at the centres gives. Preconditions: settings.cells == contours during the walk, which
// left lines[i].hits; two lines at least, and one segment at least per line. Limit: contour whose
// surface its own line does not cross (a tip or a structure between two lines) sends nothing back,
// as with sampling at the centres. normals: of each edge, with smooth normals; else empty.
void addCellEchoes(std::span<const ContourEdge> edges, std::span<const EdgeNormals> normals,
                   const Probe& probe, const TraceSettings& settings,
                   std::span<const LineTrace> lines, CellEchoes& echoes);

}  // namespace echocine
