#include "trace/layer_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/lanes.h"

namespace echocine {

namespace {

// In units of the centre frequency: beyond it the spectrum is taken for its mean over the lobes,
// 1 / (2 (f^2 - 1)^2), a ten-thousandth of the pulse's energy.
constexpr int kTailFrom = 6;
// At most so many times the nodes are doubled. The first spacing resolves 2 N cycles of delay.
constexpr int kMostDoublings = 7;
constexpr double kConverged = 1e-3;  // relative change at which doubling stops: 0.004 dB

struct Phasors4 {
  Doubles4 re{}, im{};
};
Phasors4 operator*(Phasors4 a, Phasors4 b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

Phasor exponentialOf(Phasor p) {
  const double size = p.re == 0 ? 1 : std::exp(p.re);
  return {size * std::cos(p.im), size * std::sin(p.im)};
}

using Waves = std::array<Phasors4, LayerFaces::kMostLayers>;  // E^2 in each layer at four nodes

struct Responses4 {
  Doubles4 reflected, passed_twice;
};

// The recursion of layer_stack.h. |t|^2 needs the squares of its factors alone.
Responses4 responsesAt(const LayerFaces& faces, const Waves& E_squared) {
  std::size_t i = faces.layers;
  const Phasor last = faces.r[i];
  Doubles4 G_re = Doubles4{} + last.re, G_im = Doubles4{} + last.im;
  Doubles4 t_norm = Doubles4{} + norm(Phasor{1 + last.re, last.im});
  while (i-- > 0) {
    const Phasors4& E = E_squared[i];
    const Phasor r = faces.r[i], passing = Phasor{1, 0} - r * r;
    const Phasors4 behind = Phasors4{G_re, G_im} * E;
    const Doubles4 d_re = 1 + faces.kept[i] * (r.re * behind.re - r.im * behind.im),
                   d_im = faces.kept[i] * (r.re * behind.im + r.im * behind.re);
    const Doubles4 per_turns = 1 / (d_re * d_re + d_im * d_im);
    const Phasors4 inverse{d_re * per_turns, -d_im * per_turns};
    const Phasors4 back = behind * inverse;
    G_re = r.re + passing.re * back.re - passing.im * back.im;
    G_im = r.im + passing.re * back.im + passing.im * back.re;
    t_norm *= norm(Phasor{1 + r.re, r.im}) * per_turns;
    // |E|^2 of a wave that propagates is 1.
    if (faces.phase[i].re != 0) t_norm *= squareRoot(E.re * E.re + E.im * E.im);
  }
  const Doubles4 through = t_norm * faces.flux;
  return {G_re * G_re + G_im * G_im, through * through};
}

struct WeighedSum {
  double weight = 0, reflected = 0, passed_twice = 0;

  void add(Doubles4 weights, const Responses4& of) {
    const auto sum = [](Doubles4 v) { return (v[0] + v[1]) + (v[2] + v[3]); };
    weight += sum(weights);
    reflected += sum(weights * of.reflected);
    passed_twice += sum(weights * of.passed_twice);
  }
  void add(const WeighedSum& other, double scale) {
    weight += scale * other.weight;
    reflected += scale * other.reflected;
    passed_twice += scale * other.passed_twice;
  }
  StackResponse mean() const { return {reflected / weight, passed_twice / weight}; }
};

// How long, in cycles, the stack still rings: each layer's delay for as often as it is gone
// through until the rest is small.
double ringing(const LayerFaces& faces) {
  double cycles = 0;
  for (std::size_t i = 0; i < faces.layers; ++i) {
    const double left = faces.kept[i] * std::sqrt(norm(faces.r[i]) * norm(faces.r[i + 1]));
    cycles += faces.phase[i].im / std::numbers::pi * (1 + 4 / std::max(1 - left, 1e-3));
  }
  return cycles;
}

// The wave reflected twice in each layer is so weak that the first nodes suffice.
bool isWeak(const LayerFaces& faces) {
  constexpr double kWeakReflectance = 0.05;
  for (std::size_t i = 0; i < faces.layers; ++i)
    if (norm(faces.r[i]) * norm(faces.r[i + 1]) > kWeakReflectance * kWeakReflectance) return false;
  return true;
}

// The numerator of W at the nodes f = j / (2 N 2^doublings): sin^2 or cos^2 of pi j / 2^(doublings
// + 1), which repeats.
class Lobes {
 public:
  static const Lobes& table() {
    static const Lobes lobes;
    return lobes;
  }
  double at(bool whole, int j, int doublings) const {
    const int place = (j << (kMostDoublings - doublings)) + (whole ? 0 : kQuarter);
    return squares_[static_cast<std::size_t>(place & (2 * kQuarter - 1))];
  }

 private:
  static constexpr int kQuarter = 1 << kMostDoublings;  // pi / 2
  Lobes() {
    for (std::size_t k = 0; k < squares_.size(); ++k) {
      const double wave = std::sin(std::numbers::pi / 2 * static_cast<double>(k) / kQuarter);
      squares_[k] = wave * wave;
    }
  }
  std::array<double, 2 * kQuarter> squares_{};
};

// The sum over the inner spectrum, on nodes that can be doubled.
class InnerSum {
 public:
  InnerSum(const LayerFaces& faces, double N)
      : faces_(faces), N_(N), whole_(std::fmod(2 * N, 2.0) == 0) {
    // Every other node has no weight, but for the centre, where the spectrum's zero meets its pole.
    addNodes(whole_ ? 1 : 0);
    addCentre();
  }

  // Halves the spacing.
  void refine() {
    WeighedSum halved;
    halved.add(sum_, 0.5);
    sum_ = halved;
    ++doublings_;
    addNodes(1);
  }
  const WeighedSum& sum() const { return sum_; }

 private:
  double perCycle() const { return 2 * N_ * (1 << doublings_); }

  // W of the node j, times the spacing.
  double weight(int j, int nodes) const {
    if (j > nodes) return 0;
    const double f = j / perCycle(), off = f * f - 1;
    if (off == 0) return 0;
    const double share = j == 0 || j == nodes ? 0.5 : 1;  // of the trapezoidal rule's ends
    return share / perCycle() * lobes_.at(whole_, j, doublings_) / (off * off);
  }

  // Every other node from the first on.
  void addNodes(int first) {
    const auto nodes = static_cast<int>(std::round(kTailFrom * perCycle()));
    Waves E, step;
    for (std::size_t i = 0; i < faces_.layers; ++i) {
      const Phasor phase = (2 / perCycle()) * faces_.phase[i];  // of E^2 from node to node
      const Phasor two = exponentialOf(2 * phase), four = two * two, eight = four * four;
      Phasor at = first == 0 ? Phasor{1, 0} : exponentialOf(phase);
      for (std::size_t lane = 0; lane < kDoubleLanes; ++lane, at = at * two) {
        E[i].re[lane] = at.re;
        E[i].im[lane] = at.im;
      }
      step[i] = {Doubles4{} + eight.re, Doubles4{} + eight.im};
    }
    for (int j = first; j <= nodes; j += 8) {
      const Doubles4 weights{weight(j, nodes), weight(j + 2, nodes), weight(j + 4, nodes),
                             weight(j + 6, nodes)};
      sum_.add(weights, responsesAt(faces_, E));
      for (std::size_t i = 0; i < faces_.layers; ++i) E[i] = E[i] * step[i];
    }
  }

  void addCentre() {
    Waves E;
    for (std::size_t i = 0; i < faces_.layers; ++i) {
      const Phasor at = exponentialOf(2 * faces_.phase[i]);
      E[i] = {Doubles4{} + at.re, Doubles4{} + at.im};
    }
    const double half_X = std::numbers::pi * N_;
    sum_.add(Doubles4{half_X * half_X / 4 / perCycle()}, responsesAt(faces_, E));
  }

  const LayerFaces& faces_;
  const Lobes& lobes_ = Lobes::table();
  double N_;
  bool whole_;
  int doublings_ = 0;
  WeighedSum sum_;
};

// Beyond kTailFrom, by u = 1 / f: Gauss-Legendre of eight nodes. A film's echo grows as f^2 there.
WeighedSum tailSum(const LayerFaces& faces) {
  constexpr Doubles4 kNodes{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                            0.9602898564975363},
      kWeights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  WeighedSum tail;
  for (const double side : {-1.0, 1.0}) {
    const Doubles4 u = (1 + side * kNodes) / (2.0 * kTailFrom), past = 1 - u * u;
    Waves E;
    for (std::size_t i = 0; i < faces.layers; ++i)
      for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
        const Phasor at = exponentialOf((2 / u[lane]) * faces.phase[i]);
        E[i].re[lane] = at.re;
        E[i].im[lane] = at.im;
      }
    tail.add(kWeights / (2.0 * kTailFrom) * 0.5 * u * u / (past * past), responsesAt(faces, E));
  }
  return tail;
}

bool near(double a, double b) {
  return std::abs(a - b) <= kConverged * std::abs(a) + 1e-12;
}

StackResponse meanOf(const WeighedSum& tail, const WeighedSum& inner) {
  WeighedSum all = tail;
  all.add(inner, 1);
  return all.mean();
}

}  // namespace

StackResponse spectrumMean(const LayerFaces& faces, double N) {
  const WeighedSum tail = tailSum(faces);
  InnerSum inner(faces, N);
  const double needed = N + ringing(faces);  // nodes to a cycle
  int doublings = 0;
  for (double per_cycle = 2 * N; doublings < kMostDoublings - 1 && per_cycle < needed;
       per_cycle *= 2, ++doublings)
    inner.refine();
  StackResponse now = meanOf(tail, inner.sum());
  if (isWeak(faces)) return now;
  for (; doublings < kMostDoublings; ++doublings) {
    const StackResponse last = now;
    inner.refine();
    now = meanOf(tail, inner.sum());
    if (near(now.reflected, last.reflected) && near(now.passed_twice, last.passed_twice)) break;
  }
  return now;
}

}  // namespace echocine
