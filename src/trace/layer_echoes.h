#pragma once
// Interfaces that one pulse holds send back one echo, and take from the line what the stack of
// layers between them takes as a whole: layer_stack.h.
//
// Faces are together while the pulse is longer than the delay tau = 2 h cos(theta) / c between
// them, and beyond a critical angle while the layer's evanescent wave reaches the next face. What
// turns back between two strong faces comes later than that: it counts in full to three times the
// pulse's length, and no more from eight times on, where the ray rule is left. Faces that are no
// layer, since they lean against each other by over 60 degrees, are apart; up to 30 degrees they
// are together; between these both rules are mixed. Between 10 and 30 lengths of evanescent decay
// what low frequencies still carry through a fast layer goes to nothing. A stack ends after 48
// pulse lengths along the line, however steep it is met. (Limits are our choice.)
//
// How the echo divides among the faces decides only which structure's gain and lobe it takes. Face
// i gets a share of what it adds to the sum of amplitudes,
//   a_i sum_j a_j C(x_ij),   C(x) = (1 - x/X) cos x + sin(x)/X for x < X = 2 pi N, else 0,
// where a is the face's own amplitude after the evanescent decay before it, x the difference in
// phase and C the correlation of the pulse, a gated sine of N cycles. A face changes nothing of
// those that are a pulse's length before it.

#include <array>
#include <cstddef>
#include <span>

#include "core/vec3.h"
#include "trace/layer_stack.h"

namespace echocine {

// C of a pulse of N cycles.
double pulseCorrelation(double x, double N);

class LayerEchoes {
 public:
  static constexpr std::size_t kMostFaces = 8;

  // A face as the line meets it.
  struct Meeting {
    LayerMedium before, after;
    double cos_i = 1;
    double amplitude = 0;  // r of the ray rule, as the line takes it
    bool total = false;    // no ray goes on
    double path_m = 0;     // l along the line
    double along = 1;      // cosine between the line itself and the normal
    Vec3d normal;          // unit, against the line
  };
  struct Face {
    double amplitude = 0;
    bool total = false;
    double base = 0;           // its echo's intensity if it stood alone behind what lies before all
    std::size_t echo = 0;      // where that echo is kept, if it is
    std::size_t hit = 0;       // the first of its hits
    std::size_t hits_end = 0;  // and behind the last
  };

  LayerEchoes(double frequency_hz, double pulse_cycles);

  // Forgets all faces; what follows lies behind losses of `passed`.
  void clear(double passed) {
    count_ = 0;
    passed_ = passed;
  }
  bool empty() const { return count_ == 0; }
  double passed() const { return passed_; }  // prod (1-R)^2 before the first face

  // Whether a face belongs to those before it.
  bool holds(const Meeting& face) const;
  // Whether a wave beyond its critical angle in the last face's layer is still felt at this path.
  bool reaches(double path_m) const;
  // Preconditions: empty() or holds(meeting).
  void add(const Meeting& meeting, const Face& face);
  std::span<const Face> faces() const { return std::span(faces_).first(count_); }

  // Echo of the pulse from all faces.
  struct Together {
    std::array<double, kMostFaces> scale{};  // of each face's base
    double passed_twice = 1;
  };
  // losses: what a face sends back is missing behind it.
  // Once after each add().
  Together together(bool losses);

 private:
  // A layer between the last face and the next.
  struct Gap {
    double thickness_m = 0, layer = 1, kept = 1;  // layer: share of the stack's rule
    double cycles = 0;                            // tau times the frequency
    double decay = 0;                             // kappa h of an evanescent wave
    bool held = false;
  };
  Gap gapBefore(const Meeting& face) const;
  std::array<double, kMostFaces> shares() const;
  void deal(double reflected);

  double frequency_hz_, N_, pulse_m_;
  double first_path_m_ = 0;  // l of the first face
  std::size_t count_ = 0;
  double passed_ = 1;
  LayerMedium before_;  // all faces
  double cos_0_ = 1;    // there
  Meeting last_;
  double together_ = 1;  // share of the stack's rule; the rest is the ray rule's
  std::array<Face, kMostFaces> faces_;
  std::array<Layer, kMostFaces> layers_;      // behind each face but the last
  std::array<double, kMostFaces> phase_{};    // of each face
  std::array<double, kMostFaces> decayed_{};  // amplitude left at each, there and back
  std::array<double, kMostFaces> reach_{};    // felt() from the first to each
  std::array<double, kMostFaces> energy_{};   // what each sends back, of the pulse's
};

}  // namespace echocine
