#pragma once
// One layer between two media in which the wave propagates: the average over the pulse's spectrum
// in closed form.
//
// With real r_1 and r_2, z = E^2 = exp(i x f) and q = kept r_1 r_2, the recursion of layer_stack.h
// is a series of echoes, each one delay after the last:
//   G = r_1 + (1 - r_1^2) r_2 z sum_m (-q z)^m.
// |G|^2 is then a sum of cosines of d x f, and a cosine's average over the spectrum is the pulse's
// correlation C(d x), which is 0 from the pulse's length on:
//   <|G|^2> = G(z = 1)^2 - 2 sum_{d>0} A (-q)^(d-1) (1 - C(d x)),
//   A = r_1 (1 - r_1^2) r_2 - q ((1 - r_1^2) r_2)^2 / (1 - q^2).
// The transmitted energy is flux (1 + r_1)^2 (1 + r_2)^2 / |1 + q z|^2. Its square has the series
//   1 / |1 + q z|^4 = 1 / (1 + q)^4
//                     - 2 sum_{d>0} (-q)^d ((1 + q^2) / (1 - q^2)^3 + d / (1 - q^2)^2) (1 - C(d
//                     x)).
// 1 - C is taken, not C, so that a film's small echo is no difference of large numbers.

#include <optional>

#include "trace/layer_faces.h"

namespace echocine {

// Nothing where the series does not apply: several layers, an evanescent wave, or |q| over 0.7,
// where it takes many terms. N: half cycles as by wholeHalfCycles().
std::optional<StackResponse> layerSeries(const LayerFaces& faces, double N);

}  // namespace echocine
