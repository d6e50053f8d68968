#pragma once
// Velocities as colours over the grey picture, with a scale.

#include "doppler/doppler.h"
#include "output/overlay.h"
#include "scene/scene.h"
#include "signal/picture.h"
#include "signal/signal_chain.h"
#include "video/animation.h"

namespace echocine {

// Colours of picture indices: 0 to 127 greys, 128 to 255 velocities from -v_N to v_N. Red to
// yellow: towards the probe; blue to cyan: away from it. Colours are our choice.
GreyColours dopplerColours();

// The index of a velocity; those beyond v_N wrap round.
std::uint8_t colourIndex(double velocity_m_s, double nyquist_m_s);

class ColourOverlay {
 public:
  // Width and height of the pictures are those of the scene's output, rounded up to even numbers.
  // Keeps references.
  ColourOverlay(const Scene& scene, const SignalChain& chain, const Overlay& ticks,
                double nyquist_m_s);

  int width() const { return width_; }
  int height() const { return height_; }

  // A picture of indices. Colour replaces grey where the estimate is a number and its power at
  // least -55 dB of white, our choice. Between samples, velocities are interpolated as unit
  // vectors on the circle of 2 v_N, so that aliasing makes no false zero. white: of the loop.
  GreyImage draw(const DopplerFrame& frame, double white, double loop_position) const;

 private:
  void drawColours(const DopplerFrame& frame, double white, GreyImage& image) const;
  void drawScale(GreyImage& image) const;

  const Scene& scene_;
  const SignalChain& chain_;
  const Overlay& ticks_;
  double nyquist_m_s_;
  int width_, height_;
};

}  // namespace echocine
