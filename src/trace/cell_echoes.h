#pragma once
// The echo of an interface integrated over the beam's cell, between the half-way angles (or places)
// to both neighbouring lines, instead of sampled at the line's centre. The contour between lines is
// known, so no ray is needed. A wall along the beam thus appears as a line and not as a string of
// beads.

#include <span>
#include <vector>

#include "geometry/plane_slice.h"
#include "trace/line_trace.h"
#include "trace/trace_settings.h"

namespace echocine {

// Fills `echoes` with the echoes of the contour inside each line's cell. Each contour edge has the
// lobe at its own angle of incidence; its echo is distributed over its samples by the fraction of
// the cell that it covers in each. Media and previous losses are those of the cell's line at the
// same surface, nearest in depth. For a flat interface the sum over lines equals sampling at the
// centres. Preconditions: settings.cells == contours during the walk, which left lines[i].hits; at
// least two lines, and at least one segment per line. Limit: a contour whose surface its own line
// does not cross (a tip or a structure between two lines) has no echo, as with sampling at the
// centres. normals: of each edge, with smooth normals; otherwise empty.
void addCellEchoes(std::span<const ContourEdge> edges, std::span<const EdgeNormals> normals,
                   const Probe& probe, const TraceSettings& settings,
                   std::span<const LineTrace> lines, CellEchoes& echoes);

}  // namespace echocine
