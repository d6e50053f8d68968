#include "trace/layer_faces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace echocine {

namespace {

// Where all faces of a layer are mirrors, on its critical angle and at grazing incidence, the
// recursion is 0/0; its limit is reached well before.
Phasor cosine(double square) {
  constexpr double kLeast = 1e-12;
  return square >= 0 ? Phasor{std::sqrt(std::max(square, kLeast)), 0}
                     : Phasor{0, std::sqrt(std::max(-square, kLeast))};
}

}  // namespace

LayerFaces::LayerFaces(LayerMedium before, double cos_0, std::span<const Layer> stack,
                       LayerMedium after, double frequency_hz)
    : layers(stack.size()) {
  DCHECK_LE(layers, kMostLayers);
  const auto cosineIn = [&](LayerMedium m) { return cosine(cosineSquare(cos_0, before.c, m.c)); };
  Phasor Y = (1 / before.Z) * cosineIn(before);
  const double Y_before = Y.re;
  for (std::size_t i = 0; i <= layers; ++i) {
    const LayerMedium& next = i < layers ? stack[i].medium : after;
    const Phasor cos_next = cosineIn(next), Y_next = (1 / next.Z) * cos_next;
    r[i] = (Y - Y_next) / (Y + Y_next);
    Y = Y_next;
    if (i == layers) break;
    phase[i] = (2 * std::numbers::pi * frequency_hz * stack[i].thickness_m / next.c) *
               Phasor{-cos_next.im, cos_next.re};
    kept[i] = stack[i].kept;
  }
  flux = Y.re / Y_before;
}

}  // namespace echocine
