#pragma once
// One beat of a real loop as smoothed pictures in millimetres, for look-up under any pose.

#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "core/lanes.h"
#include "echo/beam_grid.h"
#include "echo/echo_spread.h"

namespace echocine::echo {

// Standard deviation of the smoothing: larger than speckle, smaller than the thickness of a wall;
// our choice.
inline constexpr double kEchoSmoothing_m = 2e-3;
inline constexpr double kEchoPixel_m = 1e-3;
inline constexpr int kBlockStep = 6;  // pixels between matched blocks; our choice

// The frames of a loop that form a beat.
struct BeatSpan {
  double end_diastole = 0;  // frame, possibly fractional
  double frames = 0;        // length of the beat
  // End-systole as a fraction of the beat: in the loop, and in the pictures of an EchoStack. 0:
  // unknown, pictures are evenly spaced.
  double systole = 0, shown_systole = 0;
};

// Piecewise linear warp of a beat that maps `from` to `to`, fractions of the beat; identity if
// either is 0. Durations of systole and diastole differ between hearts and with heart rate.
inline double warpedPhase(double phase, double from, double to) {
  if (!(from > 0 && to > 0)) return phase;
  const double whole = std::floor(phase), part = phase - whole;
  return whole + (part < from ? part * to / from : to + (part - from) * (1 - to) / (1 - from));
}

// An instant as a sum of successive pictures.
struct BeatPlace {
  int pictures[3] = {};
  float shares[3] = {1, 0, 0};
  double pace = 1;  // pictures per step of a model's frames
};

// Motion of the echoes at a place between successive pictures.
struct EchoMotion {
  float dx_m = 0, dz_m = 0;
  float weight = 0;  // 0..1: the correlation of the blocks; 0: no match
};

class EchoInstant;

class EchoStack {
 public:
  // `pictures` evenly spaced pictures of the beat, the first at end-diastole. The sector of a loop
  // without scale is assumed to be `depth_m` deep. Throws SceneError for less than half a beat.
  // Runs in parallel.
  EchoStack(const EchoLoop& real, const BeatSpan& beat, int pictures, double depth_m);

  // Grey 0 to 255; gradient in grey levels per mm. visible: 0 outside the sector and under
  // overlays, rising to 1 within two standard deviations of the smoothing, so that sums change
  // continuously as places cross the border.
  struct Sample {
    float grey = 0, gx = 0, gz = 0, visible = 0;
  };

  // False for pictures outside a loop that is shorter than its beat.
  bool seen(int picture) const { return !planes_[static_cast<std::size_t>(picture)].empty(); }
  bool seen(const BeatPlace& at) const {
    for (int i = 0; i < 3; ++i)
      if (at.shares[i] > 0 && !seen(at.pictures[i])) return false;
    return true;
  }
  // Pictures from `first` to before `end` are no longer seen.
  void hide(int first, int end) {
    for (int n = first; n < end; ++n) planes_[static_cast<std::size_t>(n)].clear();
  }
  double systole() const { return systole_; }  // of the pictures; 0: unknown
  int pictures() const { return static_cast<int>(planes_.size()); }
  double metresPerPixel() const { return metres_per_pixel_; }  // of the real loop
  double edgeScale() const { return edge_scale_; }             // root mean square of the gradient
  double far() const { return far_m_; }
  const EchoSpread& spread() const { return spread_; }

  // An instant of the beat for look-ups. The stack must outlive it.
  EchoInstant instant(const BeatPlace& place) const;

 private:
  friend class EchoInstant;
  void makePictures(const EchoLoop& real, const BeatSpan& beat);
  void markInside(const EchoLoop& real);
  void trackOne(std::size_t picture);
  void measureEdges();

  double metres_per_pixel_ = 0, far_m_ = 0, edge_scale_ = 1, systole_ = 0;
  int width_ = 0, height_ = 0;
  double origin_x_ = 0, origin_z_ = 0;  // of the apex, in pixels of the stack
  EchoSpread spread_;
  PixelPlane inside_;
  std::vector<std::vector<Sample>> planes_;
  std::vector<std::vector<float>> sharp_;  // for block matching only
  int blocks_across_ = 0, blocks_down_ = 0;
  std::vector<std::vector<EchoMotion>> motion_;
};

// Samples of eight places.
struct SampleLanes {
  Floats8 grey, gx, gz, visible;
};

// The loop at an instant of the beat.
class EchoInstant {
 public:
  EchoInstant(const EchoStack& stack, const BeatPlace& place);
  EchoInstant(EchoInstant&&) = default;

  const EchoStack& stack() const { return *stack_; }
  // False where a picture of the instant is outside the loop. Precondition of all that follows.
  bool seen() const { return seen_; }
  // Replaces the sum of pictures by one picture of its own: worth it for more look-ups than it has
  // pixels.
  void blend();

  // At a place, lateral and depth from the apex; visible is 0 outside the picture.
  EchoStack::Sample at(double x_m, double z_m) const {
    const double u = x_m / kEchoPixel_m + stack_->origin_x_,
                 v = z_m / kEchoPixel_m + stack_->origin_z_;
    if (!(u > 0 && v > 0 && u < stack_->width_ && v < stack_->height_)) return {};
    const PixelPlace p = pixelPlace(stack_->width_, stack_->height_, u, v);
    Floats4 sum = shares_[0] * blended(planes_[0], p);
    for (int i = 1; i < count_; ++i) sum += shares_[i] * blended(planes_[i], p);
    return {sum[0], sum[1], sum[2], sum[3]};
  }
  // The same for eight places, in less time. Places have the precision of a float.
  SampleLanes at(Floats8 x_m, Floats8 z_m) const;
  // Over a step of the model, by its pace; weight 0 outside.
  EchoMotion motionAt(double x_m, double z_m) const;

 private:
  // The four numbers of a sample at once: fits spend most of their time here.
  Floats4 blended(const EchoStack::Sample* plane, const PixelPlace& p) const {
    const EchoStack::Sample* from = plane + p.at;
    const auto lanes = [](const EchoStack::Sample* sample) {
      Floats4 out;
      std::memcpy(&out, sample, sizeof out);
      return out;
    };
    return (1 - p.right) * (1 - p.low) * lanes(from) + p.right * (1 - p.low) * lanes(from + 1) +
           (1 - p.right) * p.low * lanes(from + stack_->width_) +
           p.right * p.low * lanes(from + stack_->width_ + 1);
  }

  const EchoStack* stack_;
  BeatPlace place_;
  bool seen_;
  int count_ = 0;
  const EchoStack::Sample* planes_[3] = {};
  float shares_[3] = {};
  std::vector<EchoStack::Sample> own_;
};

inline EchoInstant EchoStack::instant(const BeatPlace& place) const {
  return {*this, place};
}

}  // namespace echocine::echo
