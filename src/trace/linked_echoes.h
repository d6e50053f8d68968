#pragma once
// Echoes of lines through the hierarchy, integrated over the beams' cells. Bent lines leave the
// imaging plane, so no contour between them is known; but neighbouring lines mostly cross the same
// wall, and between two such crossings it is taken for their chord.
//
// Two crossings are of one wall where surface and media before and behind are the same, and where
// their chord lies within 30 degrees of both tangent planes (our choice: a wall turns by no more
// than twice that within a cell). Neighbours' crossings are linked in order along both lines: as
// many as possible, and of these ways the one that links the nearest in depth.
//
// From a crossing A, s = 0, to its neighbour B, s = 1, half of the chord is in either line's cell.
// A chord seen from the apex under a small angle has rho(s) with
//   1/rho = (1 - s) / rho_A + s / rho_B,
// to a twelfth of the square of a cell's angle; rho is the depth, on a curved array that from its
// centre. Between parallel lines rho itself is linear in s. Intensity and exponent run linearly in
// s. So a chord sends back the mean of both crossings.
//
// A side without a link: where the line leaves through the same surface by which it came in, and
// neither crossing has a link on that side, the wall turns round between this line and the next.
// For a bend of constant radius let q be the distance along the line from the middle of both
// crossings over that at the crossing. The angle and the lobe cos^2 grow as q^2; so the echo,
// whose bend reaches two thirds of a cell on the mean over all places of the line, is spread as
// I/3 d(q^4). Elsewhere wall goes on in the crossing's tangent plane through half of the cell, and
// leans of tan over 10 (84 degrees) are taken for 10.
//
// Limits: a wall that no line crosses has no echo. Virtual sources of refracted rays are taken for
// the apex, which moves echo along a chord by the share that refraction changes its length.

#include <span>

#include "scene/probe.h"
#include "trace/line_trace.h"
#include "trace/trace_settings.h"

namespace echocine {

// Fills `echoes` with those of the lines, which are left with none. Precondition: the probe is that
// of the lines, two at least.
void linkEchoes(const Probe& probe, const TraceSettings& settings, std::span<LineTrace> lines,
                CellEchoes& echoes);

}  // namespace echocine
