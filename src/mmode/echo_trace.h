#pragma once
// Follows a bright echo along a line of an M-mode, as a reader traces it with callipers.

#include <span>
#include <vector>

namespace echocine {

// The grey levels of an M-mode: sample k of column t has the index t * samples + k.
struct EchoColumns {
  std::span<const float> greys;
  int columns = 0, samples = 0;
  double sample_m = 0, column_s = 0;  // spacing
};

// Displacement of the echo near `start_m` (below the upper edge of the first sample) since column
// 0, m, positive towards the probe, by column.
//
// The trace is the path z(t) that maximises
//   sum over t of g(t, z(t)) - 0.2 (v(t) / 0.15 m/s)^2,   v(t) = (z(t) - z(t-1)) / dt,
// with |v| <= 0.4 m/s and |z(0) - start| <= 3 mm, by dynamic programming on samples, for columns
// dt = 5 ms apart (or 1 / rate, if larger). g is the grey level, averaged over 1 mm. The second
// term keeps the path from jumping to a brighter wall: a healthy ring moves at 0.05 to 0.15 m/s. A
// parabola through the maximum of g within 1.5 mm of the path gives fractions of a sample. Columns
// between are interpolated linearly. All values are our choice. Precondition: at least one column.
std::vector<double> followEcho(const EchoColumns& columns, double start_m);

}  // namespace echocine
