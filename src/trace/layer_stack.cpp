#include "trace/layer_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace echocine {

namespace {

constexpr std::size_t kMostLayers = 8;
// In units of the centre frequency: beyond it the spectrum is taken for its mean over the lobes,
// 1 / (2 (f^2 - 1)^2), a ten-thousandth of the pulse's energy.
constexpr double kTailFrom = 6;
// At most so many times the nodes are doubled. The first spacing resolves 2 N cycles of delay.
constexpr int kMostDoublings = 7;
constexpr double kConverged = 1e-3;  // relative change at which doubling stops: 0.004 dB

// std::complex checks each product for infinities, which takes most of the time.
struct Phasor {
  double re = 0, im = 0;
};
Phasor operator*(Phasor a, Phasor b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
Phasor operator*(double a, Phasor b) {
  return {a * b.re, a * b.im};
}
Phasor operator+(Phasor a, Phasor b) {
  return {a.re + b.re, a.im + b.im};
}
Phasor operator-(Phasor a, Phasor b) {
  return {a.re - b.re, a.im - b.im};
}
double norm(Phasor a) {
  return a.re * a.re + a.im * a.im;
}
Phasor operator/(Phasor a, Phasor b) {
  return (1 / norm(b)) * (a * Phasor{b.re, -b.im});
}

// Where all faces of a layer are mirrors, on its critical angle and at grazing incidence, the
// recursion is 0/0; its limit is reached well before.
Phasor cosine(double square) {
  constexpr double kLeast = 1e-12;
  return square >= 0 ? Phasor{std::sqrt(std::max(square, kLeast)), 0}
                     : Phasor{0, std::sqrt(std::max(-square, kLeast))};
}

// The stack without its frequency.
class Stack {
 public:
  Stack(LayerMedium before, double cos_0, std::span<const Layer> layers, LayerMedium after,
        double frequency_hz)
      : layers_(layers) {
    DCHECK_LE(layers.size(), kMostLayers);
    const auto cosineIn = [&](LayerMedium m) { return cosine(cosineSquare(cos_0, before.c, m.c)); };
    Phasor Y = (1 / before.Z) * cosineIn(before);
    const double flux = Y.re;
    for (std::size_t i = 0; i <= layers.size(); ++i) {
      const LayerMedium& next = i < layers.size() ? layers[i].medium : after;
      const Phasor cos_next = cosineIn(next), Y_next = (1 / next.Z) * cos_next;
      r_[i] = (Y - Y_next) / (Y + Y_next);
      Y = Y_next;
      if (i < layers.size())
        phase_[i] = (2 * std::numbers::pi * frequency_hz * layers[i].thickness_m / next.c) *
                    Phasor{-cos_next.im, cos_next.re};  // of E = exp(phase f)
    }
    flux_ = Y.re / flux;
  }

  StackResponse at(double f) const {
    std::size_t i = layers_.size();
    Phasor G = r_[i], t = Phasor{1, 0} + G;
    while (i-- > 0) {
      const Phasor E = std::exp(f * phase_[i].re) *
                       Phasor{std::cos(f * phase_[i].im), std::sin(f * phase_[i].im)};
      const Phasor behind = G * E * E, r = r_[i], one{1, 0};
      const Phasor per_turns = one / (one + layers_[i].kept * (r * behind));
      G = r + (one - r * r) * behind * per_turns;
      t = (one + r) * t * E * per_turns;
    }
    const double through = norm(t) * flux_;
    return {norm(G), through * through};
  }

  // How long, in cycles, the stack still rings: each layer's delay for as often as it is gone
  // through until what is left is small.
  double ringing() const {
    double cycles = 0;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const double left = layers_[i].kept * std::sqrt(norm(r_[i]) * norm(r_[i + 1]));
      cycles += phase_[i].im / std::numbers::pi * (1 + 4 / std::max(1 - left, 1e-3));
    }
    return cycles;
  }

  // What turns back twice in each layer is so little that the first nodes hold all of it.
  bool weak() const {
    constexpr double kWeakReflectance = 0.05;
    for (std::size_t i = 0; i < layers_.size(); ++i)
      if (norm(r_[i]) * norm(r_[i + 1]) > kWeakReflectance * kWeakReflectance) return false;
    return true;
  }

 private:
  std::span<const Layer> layers_;
  std::array<Phasor, kMostLayers + 1> r_;
  std::array<Phasor, kMostLayers> phase_;
  double flux_ = 1;  // energy flux of a wave of pressure 1 behind the stack over that before it
};

struct WeighedSum {
  double weight = 0;
  StackResponse of{0, 0};

  void add(const Stack& stack, double f, double w) {
    if (w == 0) return;
    const StackResponse r = stack.at(f);
    weight += w;
    of.reflected += w * r.reflected;
    of.passed_twice += w * r.passed_twice;
  }
  void add(const WeighedSum& other, double scale) {
    weight += scale * other.weight;
    of.reflected += scale * other.of.reflected;
    of.passed_twice += scale * other.of.passed_twice;
  }
  StackResponse mean() const { return {of.reflected / weight, of.passed_twice / weight}; }
};

double spectrum(double f, double N) {
  const double off = f * f - 1, half_X = std::numbers::pi * N;
  if (std::abs(off) < 1e-7) return half_X * half_X / 4;
  const bool whole = std::fmod(2 * N, 2.0) == 0;
  const double wave = whole ? std::sin(half_X * f) : std::cos(half_X * f);
  return wave * wave / (off * off);
}

// Beyond kTailFrom, by u = 1 / f: Gauss-Legendre of eight nodes. A film's echo grows as f^2 there.
void addTail(const Stack& stack, WeighedSum& sum) {
  constexpr std::array<std::array<double, 2>, 8> kNodes{{{-0.9602898564975363, 0.1012285362903763},
                                                         {-0.7966664774136267, 0.2223810344533745},
                                                         {-0.5255324099163290, 0.3137066458778873},
                                                         {-0.1834346424956498, 0.3626837833783620},
                                                         {0.1834346424956498, 0.3626837833783620},
                                                         {0.5255324099163290, 0.3137066458778873},
                                                         {0.7966664774136267, 0.2223810344533745},
                                                         {0.9602898564975363, 0.1012285362903763}}};
  for (const auto& [x, w] : kNodes) {
    const double u = (1 + x) / (2 * kTailFrom), past = 1 - u * u;
    sum.add(stack, 1 / u, w / (2 * kTailFrom) * 0.5 * u * u / (past * past));
  }
}

bool near(double a, double b) {
  return std::abs(a - b) <= kConverged * std::abs(a) + 1e-12;
}

}  // namespace

double cosineSquare(double cos_0, double c_0, double c) {
  const double r = c / c_0;
  return (c_0 - c) / c_0 * (1 + r) + r * r * cos_0 * cos_0;
}

double wholeHalfCycles(double pulse_cycles) {
  return std::max(std::round(2 * pulse_cycles), 1.0) / 2;
}

// The pulse is N cycles long, so equally spaced nodes give the mean of anything that repeats after
// a delay exactly, as long as that delay is under 1 / spacing - N: the trapezoidal rule is the
// Gaussian one for it. Nodes are doubled until nothing changes; each time only the new ones are
// computed.
StackResponse stackResponse(LayerMedium before, double cos_0, std::span<const Layer> layers,
                            LayerMedium after, double frequency_hz, double pulse_cycles) {
  const Stack stack(before, cos_0, layers, after, frequency_hz);
  const double N = wholeHalfCycles(pulse_cycles);
  double per_cycle = 2 * N;
  int doublings = 0;
  for (; doublings < kMostDoublings - 1 && per_cycle < N + stack.ringing(); ++doublings)
    per_cycle *= 2;
  auto nodes = static_cast<int>(std::round(kTailFrom * per_cycle));
  WeighedSum tail, inner;
  addTail(stack, tail);
  for (int j = 0; j <= nodes; ++j) {
    const double f = kTailFrom * j / nodes;
    inner.add(stack, f, spectrum(f, N) * (j == 0 || j == nodes ? 0.5 : 1) * kTailFrom / nodes);
  }
  WeighedSum all = tail;
  all.add(inner, 1);
  for (; doublings < kMostDoublings && !stack.weak(); ++doublings) {
    WeighedSum between;
    for (int j = 0; j < nodes; ++j) {
      const double f = kTailFrom * (j + 0.5) / nodes;
      between.add(stack, f, spectrum(f, N) * kTailFrom / nodes);
    }
    nodes *= 2;
    inner.add(between, 1);
    WeighedSum halved;
    halved.add(inner, 0.5);
    inner = halved;
    const StackResponse last = all.mean();
    all = tail;
    all.add(inner, 1);
    const StackResponse now = all.mean();
    if (near(now.reflected, last.reflected) && near(now.passed_twice, last.passed_twice)) break;
  }
  const StackResponse found = all.mean();
  return {std::min(found.reflected, 1.0), std::min(found.passed_twice, 1.0)};
}

}  // namespace echocine
