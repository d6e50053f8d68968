#pragma once
// Receiver noise and near-field clutter: fields that add to the echoes' field before the envelope.

#include <cstdint>
#include <span>
#include <vector>

#include "core/normal_lanes.h"
#include "scene/scene.h"
#include "signal/random_plane.h"

namespace echocine {

// White as a float that leaves room for products.
float heldWhite(double white);

// Mean powers over white, by sample: of the receiver's noise, and of the near-field clutter up to
// its end. Their classes below have the equations.
std::vector<float> noiseLevels(const Scene& scene, std::span<const float> gains);
// window_db: EffectPlan::clutter_window_db.
std::vector<float> clutterLevels(const Scene& scene, bool harmonic = false, double window_db = 0);

// Complex Gaussian noise of the receiver. Before the time gain it is white in depth and of equal
// power at all depths; the filter of the pulse limits its band, as it does that of the echoes.
// Lines are received one after the other, so their noise is independent, as is that of two frames:
// each number is a hash of seed, instant, line and sample. The mean power at sample k is
// level white gain_k / max(gain); without gains it is uniform in depth.
class ReceiverNoise {
 public:
  ReceiverNoise(const Scene& scene, std::span<const float> gains);

  // Adds a line's noise to the real and imaginary part of its field.
  void add(double white, double time_s, int line, float* real, float* imaginary) const;

 private:
  void filterEach(const float* from, float* to) const;
  void filterBetween(const float* from, float* to) const;

  int samples_, seed_;
  int per_node_;  // samples per white number: 1, or 8 or more where the pulse is that long
  int reach_;     // of the filter, in nodes
  // Filter by distance; with several samples per node, by sample between two nodes, then distance.
  std::vector<float> taps_;
  std::vector<float> amplitudes_;
};

// Reverberation between face and chest wall: mean power level white exp(-r / length) at the path
// length r. It stands still with the probe while the heart beats, or is renewed as skin and probe
// move with breathing: after clutter_time_s it is the next of independent fields, and cos and sin
// of a quarter turn blend two of them in between, which keeps the mean power. Its grain is at least
// as wide as a cell of speckle; near the face of a phased probe with signal.receive_f_number it
// widens with that. It ends 60 dB below its level. The second harmonic has hardly built up there:
// its clutter is weaker by the build-up and its gain (harmonic.h).
class NearFieldClutter {
 public:
  explicit NearFieldClutter(const Scene& scene, bool harmonic = false, double window_db = 0);

  void add(double white, double time_s, int line, float* real, float* imaginary) const;

 private:
  PlaneShift drawn(std::int64_t number, int attempt) const;
  PlaneShift shiftOf(std::int64_t number) const;
  void addField(float scale, std::int64_t number, int line, float* real, float* imaginary) const;
  void addWidened(float scale, PlaneShift shift, int line, float* real, float* imaginary) const;

  std::vector<float> amplitudes_;  // up to its end
  double renewed_s_;
  std::uint64_t seed_;
  RandomPlane random_;
  // Near the face, lines are so much closer to the middle of the plane.
  std::vector<float> closer_;
  float middle_line_;
  float unlike_ = 0;  // 1 less the correlation of neighbouring lines of the plane
};

}  // namespace echocine
