#pragma once
// Interfaces closer than the pulse is long send back one echo, of their summed amplitudes.
//
// Two faces of a layer of thickness h with amplitudes r_1 and r_2 lie x = 2 k h cos theta apart in
// phase. A pulse of N cycles, a gated sine, returns from both the energy
//   r_1^2 + r_2^2 + 2 r_1 r_2 C(x),   C(x) = (1 - x/X) cos x + sin(x)/X for x < X = 2 pi N, else 0,
// where C is the pulse's own correlation. For a layer between equal media and x << 1 that is
// 4 sin^2(k h cos theta) R: it goes to nothing as the layer does. Several faces sum in pairs.
// Echoes between the faces: with S the sum above and P = prod (1 - r^2), what comes back is
// S / (S + P), which for one frequency is Airy's formula, and P / (S + P) goes through.

#include <array>
#include <cstddef>
#include <span>

namespace echocine {

// C of a pulse of N cycles.
double pulseCorrelation(double x, double N);

class LayerEchoes {
 public:
  struct Face {
    double amplitude = 0;      // r
    double phase = 0;          // x since the first face
    double base = 0;           // its echo's intensity if it stood alone behind what lies before all
    std::size_t echo = 0;      // where that echo is kept, if it is
    std::size_t hit = 0;       // the first of its hits
    std::size_t hits_end = 0;  // and behind the last
  };

  // Forgets all faces; what follows lies behind losses of `passed`.
  void clear(double passed) {
    count_ = 0;
    passed_ = passed;
  }
  bool empty() const { return count_ == 0; }
  bool full() const { return count_ == faces_.size(); }
  double passed() const { return passed_; }  // prod (1-R)^2 before the first face
  double lastPhase() const { return count_ == 0 ? 0 : faces_[count_ - 1].phase; }
  void add(const Face& face) { faces_[count_++] = face; }
  std::span<const Face> faces() const { return std::span(faces_).first(count_); }

  // What the pulse gets back from all faces.
  struct Together {
    std::array<double, 8> scale{};  // of each face's own echo
    double through = 1;             // P / (S + P)
  };
  // losses: echoes between the faces count.
  Together together(double pulse_cycles, bool losses) const;

 private:
  std::size_t count_ = 0;
  double passed_ = 1;
  std::array<Face, 8> faces_;
};

}  // namespace echocine
