#include "trace/layer_echoes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "scene/probe.h"

namespace echocine {

namespace {

// Between weaker faces, by the product of their amplitudes, what turns back is under 0.05 dB.
constexpr double kWeak = 0.05;
constexpr double kKeptTo = 3, kKeptEnd = 8;                          // in lengths of the pulse
constexpr double kApart = 0.5, kParallel = std::numbers::sqrt3 / 2;  // cosines of 60 and 30 degrees
constexpr double kDecayTo = 10, kDecayEnd = 30;                      // kappa h
// Lengths of the pulse that a stack may take of the line. Half a millimetre at 85 degrees has ten.
constexpr double kPathTo = 10, kPathFrom = 24, kPathEnd = 48;

double smoothStep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

double square(double x) {
  return x * x;
}

// Weight of an evanescent wave after so many decay lengths.
double felt(double decay) {
  return 1 - smoothStep((decay - kDecayTo) / (kDecayEnd - kDecayTo));
}

}  // namespace

double pulseCorrelation(double x, double N) {
  const double X = 2 * std::numbers::pi * N;
  if (x >= X) return 0;
  return (1 - x / X) * std::cos(x) + std::sin(x) / X;
}

LayerEchoes::LayerEchoes(double frequency_hz, double pulse_cycles)
    : frequency_hz_(frequency_hz),
      N_(pulse_cycles > 0 ? wholeHalfCycles(pulse_cycles) : 0),
      pulse_m_(N_ * kScannerSpeed / frequency_hz / 2) {}

LayerEchoes::Gap LayerEchoes::gapBefore(const Meeting& face) const {
  Gap gap;
  gap.thickness_m = (face.path_m - last_.path_m) * face.along;
  gap.layer = smoothStep((dot(last_.normal, face.normal) - kApart) / (kParallel - kApart));
  const double c = last_.after.c, cos_square = cosineSquare(cos_0_, before_.c, c);
  const double pulses = (face.path_m - first_path_m_) / pulse_m_;
  const double one_way = frequency_hz_ * gap.thickness_m * std::sqrt(std::abs(cos_square)) / c;
  if (cos_square < 0) {
    gap.decay = 2 * std::numbers::pi * one_way;
    gap.layer *= felt(gap.decay);
    gap.held = true;
  } else {
    gap.cycles = 2 * one_way;
    const double lengths = gap.cycles / N_;
    const bool weak = std::abs(last_.amplitude * face.amplitude) < kWeak;
    gap.kept = 1 - smoothStep((lengths - kKeptTo) / (kKeptEnd - kKeptTo));
    gap.kept *= 1 - smoothStep((pulses - kPathTo) / (kPathFrom - kPathTo));
    gap.held = lengths < (weak ? 1 : kKeptEnd);
  }
  gap.layer *= 1 - smoothStep((pulses - kPathFrom) / (kPathEnd - kPathFrom));
  gap.held = gap.held && gap.layer > 0;
  return gap;
}

bool LayerEchoes::holds(const Meeting& face) const {
  return N_ > 0 && count_ > 0 && count_ < kMostFaces && gapBefore(face).held;
}

bool LayerEchoes::reaches(double path_m) const {
  const double c = last_.after.c, cos_square = cosineSquare(cos_0_, before_.c, c);
  if (N_ == 0 || path_m > first_path_m_ + kPathEnd * pulse_m_) return false;
  if (cos_square >= 0) return true;
  // A face that leans by up to 60 degrees against the last one lies no nearer along its normal.
  const double least_m = (path_m - last_.path_m) * last_.along * kApart;
  return 2 * std::numbers::pi * frequency_hz_ * least_m * std::sqrt(-cos_square) / c < kDecayEnd;
}

void LayerEchoes::add(const Meeting& meeting, const Face& face) {
  DCHECK_LT(count_, kMostFaces);
  if (count_ == 0) {
    before_ = meeting.before;
    cos_0_ = meeting.cos_i;
    first_path_m_ = meeting.path_m;
    together_ = decayed_[0] = reach_[0] = 1;
    phase_[0] = 0;
  } else {
    const Gap gap = gapBefore(meeting);
    layers_[count_ - 1] = {meeting.before, gap.thickness_m, gap.kept};
    together_ *= gap.layer;
    phase_[count_] = phase_[count_ - 1] + 2 * std::numbers::pi * gap.cycles;
    decayed_[count_] = decayed_[count_ - 1] * std::exp(-2 * gap.decay);
    reach_[count_] = reach_[count_ - 1] * felt(gap.decay);
  }
  energy_[count_] = square(face.amplitude);
  faces_[count_++] = face;
  last_ = meeting;
}

// Shares of the sum, in any unit. If faces are far apart, each echo has the losses before it.
std::array<double, LayerEchoes::kMostFaces> LayerEchoes::shares() const {
  std::array<double, kMostFaces> share{};
  for (std::size_t i = 0; i < count_; ++i) {
    const double own = faces_[i].amplitude * decayed_[i];
    double sum = 0, left = 1;
    for (std::size_t j = 0; j < count_; ++j) {
      const double C = i == j ? 1 : pulseCorrelation(std::abs(phase_[i] - phase_[j]), N_);
      sum += faces_[j].amplitude * decayed_[j] * C;
      if (j < i) left *= square(1 - (1 - std::abs(C)) * square(faces_[j].amplitude));
    }
    // A pair's share may leave a weak face below nothing: the others bear it.
    share[i] = std::max(own * sum, 0.0) * left;
  }
  return share;
}

// Distributes the echo of the whole stack. A face farther from the last one than the pulse length
// keeps its own echo; echoes from behind it arrive later.
void LayerEchoes::deal(double reflected) {
  const std::array<double, kMostFaces> share = shares();
  std::array<double, kMostFaces> open{};
  double kept = 0, sum = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double lengths = (phase_[count_ - 1] - phase_[i]) / (2 * std::numbers::pi * N_);
    open[i] = std::max(1 - lengths, 0.0) * reach_[count_ - 1] / reach_[i];
    energy_[i] *= 1 - open[i];
    kept += energy_[i];
    sum += open[i] * share[i];
  }
  const double rest = std::max(reflected - kept, 0.0);
  const double less = kept > reflected ? reflected / kept : 1;
  for (std::size_t i = 0; i < count_; ++i)
    energy_[i] = less * energy_[i] + (sum > 0 ? rest * open[i] * share[i] / sum : 0);
}

LayerEchoes::Together LayerEchoes::together(bool losses) {
  const StackResponse stack = stackResponse(before_, cos_0_, std::span(layers_).first(count_ - 1),
                                            last_.after, frequency_hz_, N_);
  deal(stack.reflected);
  Together result;
  double ray = 1;  // what the ray rule lets through to the face, there and back
  bool mirror = false;
  for (std::size_t i = 0; i < count_; ++i) {
    const double r2 = square(faces_[i].amplitude);
    const double coherent = r2 > 0 ? energy_[i] / r2 : 0;
    result.scale[i] = together_ * coherent + (1 - together_) * ray;
    mirror = mirror || faces_[i].total;
    ray *= mirror ? 0 : losses ? square(1 - r2) : 1;
  }
  const double passed = losses || mirror ? stack.passed_twice : 1;
  result.passed_twice = together_ * passed + (1 - together_) * ray;
  return result;
}

}  // namespace echocine
