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

void EchoInstant::at(Floats8 x_m, Floats8 z_m, EchoStack::Sample out[kFloatLanes]) const {
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
  for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
    Floats4 sum{};
    for (int i = 0; i < count_; ++i) {
      const float* from = &planes_[i][pixel[lane]].grey;
      const float* below = from + 4 * width;
      sum += shares_[i] * (shares[0][lane] * fourAt(from) + shares[1][lane] * fourAt(from + 4) +
                           shares[2][lane] * fourAt(below) + shares[3][lane] * fourAt(below + 4));
    }
    out[lane] = {sum[0], sum[1], sum[2], sum[3]};
  }
}

EchoMotion EchoInstant::motionAt(double x_m, double z_m) const {
  EchoMotion out;
  for (int i = 0; i < 3; ++i) {
    if (!(place_.shares[i] > 0)) continue;
    const EchoMotion v = stack_->motionAt(place_.pictures[i], x_m, z_m);
    const float w = place_.shares[i] * v.weight;
    out.dx_m += w * v.dx_m, out.dz_m += w * v.dz_m, out.weight += w;
  }
  if (out.weight > 0) out.dx_m /= out.weight, out.dz_m /= out.weight;
  const auto pace = static_cast<float>(place_.pace);
  out.dx_m *= pace, out.dz_m *= pace;
  return out;
}

}  // namespace echocine::echo
