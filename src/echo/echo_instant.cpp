// Look-ups at an instant of a beat.

#include "echo/echo_stack.h"

namespace echocine::echo {

EchoInstant::EchoInstant(const EchoStack& stack, const BeatPlace& place)
    : stack_(&stack), place_(place), seen_(stack.seen(place)) {
  for (int i = 0; i < 3 && seen_; ++i)
    if (place.shares[i] > 0) {
      planes_[count_] = stack.planes_[static_cast<std::size_t>(place.pictures[i])].data();
      shares_[count_++] = place.shares[i];
    }
}

void EchoInstant::blend() {
  if (count_ < 2) return;
  const std::size_t numbers = 4 * stack_->inside_.size();
  static_assert(sizeof(EchoStack::Sample) == 4 * sizeof(float));
  own_.resize(stack_->inside_.size());
  float* to = &own_.front().grey;
  const auto from = [&](int i) { return &planes_[i]->grey; };
  for (std::size_t k = 0; k < numbers; k += 4) {
    Floats4 sum = shares_[0] * fourAt(from(0) + k);
    for (int i = 1; i < count_; ++i) sum += shares_[i] * fourAt(from(i) + k);
    std::memcpy(to + k, &sum, sizeof sum);
  }
  planes_[0] = own_.data();
  shares_[0] = 1;
  count_ = 1;
}

namespace {

// Samples of four numbers become lanes of each number.
SampleLanes transposed(const Floats4 samples[kFloatLanes]) {
  const Floats8 a = joined(samples[0], samples[4]), b = joined(samples[1], samples[5]),
                c = joined(samples[2], samples[6]), d = joined(samples[3], samples[7]);
  const Floats8 ab_low = __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13),
                ab_high = __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15),
                cd_low = __builtin_shufflevector(c, d, 0, 8, 1, 9, 4, 12, 5, 13),
                cd_high = __builtin_shufflevector(c, d, 2, 10, 3, 11, 6, 14, 7, 15);
  return {__builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15)};
}

}  // namespace

SampleLanes EchoInstant::at(Floats8 x_m, Floats8 z_m) const {
  constexpr auto kPerMetre = static_cast<float>(1 / kEchoPixel_m);
  const int width = stack_->width_, height = stack_->height_;
  const auto wide = static_cast<float>(width), high = static_cast<float>(height);
  const Floats8 u = x_m * kPerMetre + static_cast<float>(stack_->origin_x_),
                v = z_m * kPerMetre + static_cast<float>(stack_->origin_z_), none{};
  const Ints8 inside = (u > 0) & (v > 0) & (u < wide) & (v < high);
  const auto within = [&](Floats8 place, float most) {
    return inside ? smaller(larger(place - 0.5f, none), none + most) : none;
  };
  const Floats8 a = within(u, wide - 1), b = within(v, high - 1);
  const auto pixelOf = [](Floats8 place, int most) {
    const Ints8 pixel = __builtin_convertvector(place, Ints8);
    return pixel < most ? pixel : Ints8{} + most;
  };
  const Ints8 column = pixelOf(a, width - 2), row = pixelOf(b, height - 2);
  const Floats8 right = a - __builtin_convertvector(column, Floats8),
                low = b - __builtin_convertvector(row, Floats8);
  const Floats8 full = inside ? none + 1 : none;
  const Floats8 shares[4] = {full * (1 - right) * (1 - low), full * right * (1 - low),
                             full * (1 - right) * low, full * right * low};
  const Ints8 pixel = row * width + column;
  Floats4 out[kFloatLanes];
  for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
    Floats4 sum{};
    for (int i = 0; i < count_; ++i) {
      const float* from = &planes_[i][pixel[lane]].grey;
      const float* below = from + 4 * width;
      sum += shares_[i] * (shares[0][lane] * fourAt(from) + shares[1][lane] * fourAt(from + 4) +
                           shares[2][lane] * fourAt(below) + shares[3][lane] * fourAt(below + 4));
    }
    out[lane] = sum;
  }
  return transposed(out);
}

// Each picture's blocks around the place, weighted by their match; then the pictures.
EchoMotion EchoInstant::motionAt(double x_m, double z_m) const {
  const int across = stack_->blocks_across_;
  const double u = (x_m / kEchoPixel_m + stack_->origin_x_ - 0.5) / kBlockStep,
               v = (z_m / kEchoPixel_m + stack_->origin_z_ - 0.5) / kBlockStep;
  EchoMotion out;
  if (!(u >= 0 && v >= 0 && u < across - 1 && v < stack_->blocks_down_ - 1)) return out;
  const auto i = static_cast<std::ptrdiff_t>(u), j = static_cast<std::ptrdiff_t>(v);
  const auto fu = static_cast<float>(u - static_cast<double>(i)),
             fv = static_cast<float>(v - static_cast<double>(j));
  const float shares[] = {(1 - fu) * (1 - fv), fu * (1 - fv), (1 - fu) * fv, fu * fv};
  const std::ptrdiff_t offsets[] = {0, 1, across, across + 1};
  for (int n = 0; n < 3; ++n) {
    const std::vector<EchoMotion>& field =
        stack_->motion_[static_cast<std::size_t>(place_.pictures[n])];
    if (!(place_.shares[n] > 0) || field.empty()) continue;
    const EchoMotion* m = field.data() + j * across + i;
    EchoMotion one;
    for (int k = 0; k < 4; ++k) {
      const EchoMotion& block = m[offsets[k]];
      const float w = shares[k] * block.weight;
      one.dx_m += w * block.dx_m, one.dz_m += w * block.dz_m, one.weight += w;
    }
    if (!(one.weight > 0)) continue;
    const float w = place_.shares[n] * one.weight;
    out.dx_m += w * (one.dx_m / one.weight), out.dz_m += w * (one.dz_m / one.weight);
    out.weight += w;
  }
  if (!(out.weight > 0)) return {};
  const auto pace = static_cast<float>(place_.pace);
  out.dx_m = out.dx_m / out.weight * pace, out.dz_m = out.dz_m / out.weight * pace;
  return out;
}

}  // namespace echocine::echo
