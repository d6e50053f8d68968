#pragma once
// A stack of layers without its frequency: the faces' amplitudes and the layers' phases.

#include <array>
#include <cstddef>
#include <span>

#include "trace/layer_stack.h"

namespace echocine {

// std::complex checks each product for infinities, which takes most of the time.
struct Phasor {
  double re = 0, im = 0;
};
inline Phasor operator*(Phasor a, Phasor b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
inline Phasor operator*(double a, Phasor b) {
  return {a * b.re, a * b.im};
}
inline Phasor operator+(Phasor a, Phasor b) {
  return {a.re + b.re, a.im + b.im};
}
inline Phasor operator-(Phasor a, Phasor b) {
  return {a.re - b.re, a.im - b.im};
}
inline double norm(Phasor a) {
  return a.re * a.re + a.im * a.im;
}
inline Phasor operator/(Phasor a, Phasor b) {
  return (1 / norm(b)) * (a * Phasor{b.re, -b.im});
}

struct LayerFaces {
  static constexpr std::size_t kMostLayers = 8;

  std::size_t layers = 0;
  std::array<Phasor, kMostLayers + 1> r;   // of the face before each layer, and of the last face
  std::array<Phasor, kMostLayers> phase;   // E = exp(phase f), f in units of the centre frequency
  std::array<double, kMostLayers> kept{};  // as Layer::kept
  double flux = 1;  // energy flux of a wave of pressure 1 behind the stack over that before it

  // Preconditions as of stackResponse().
  LayerFaces(LayerMedium before, double cos_0, std::span<const Layer> stack, LayerMedium after,
             double frequency_hz);
};

}  // namespace echocine
