#include "signal/chest_screen.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "core/normal_field.h"

namespace echocine {

namespace {

constexpr std::uint64_t kScreen = 21;  // purpose of hashed numbers
// Half the width of the table, and its steps: eight in a grain, at least 0.1 mm. Our choice.
constexpr double kHalf_m = 0.25, kStepsPerGrain = 8, kLeastStep_m = 1e-4, kMostStep_m = 1e-3;

}  // namespace

ChestScreen::ChestScreen(const Probe& probe, const ArtefactSettings& settings)
    : aperture_m_(probe.aperture_m),
      depth_m_(settings.shading_depth_m),
      step_m_(std::clamp(settings.shading_grain_m / kStepsPerGrain, kLeastStep_m, kMostStep_m)),
      sums_{0.0} {
  NormalField field(settings.shading_grain_m, hashOf(settings.shading_seed, kScreen));
  const double s = settings.shading_db * std::numbers::ln10 / 20;
  const auto transmission = [&](double x_m) {
    return std::exp(-s * field.at(toFloat({x_m, 0, 0})) - s * s / 2);
  };
  const int steps = static_cast<int>(std::ceil(2 * kHalf_m / step_m_));
  for (int i = 0; i < steps; ++i)
    sums_.push_back(sums_.back() + step_m_ * transmission(-kHalf_m + (i + 0.5) * step_m_));
}

// t is constant within a step.
double ChestScreen::integral(double x_m) const {
  const double place = (x_m + kHalf_m) / step_m_;
  const auto last = sums_.size() - 2;
  const auto step = static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(last)));
  return sums_[step] + (place - static_cast<double>(step)) * (sums_[step + 1] - sums_[step]);
}

double ChestScreen::mean(double left_m, double right_m) const {
  return (integral(right_m) - integral(left_m)) / (right_m - left_m);
}

double ChestScreen::factor(double start_x_m, double x_m, double z_m, double start_z_m) const {
  constexpr double kLeastWidth_m = 1e-5;  // within the wall paths still need a width
  const double way_m = z_m - start_z_m, to_screen_m = depth_m_ - start_z_m;
  const double passed = std::clamp(way_m / to_screen_m, 0.0, 1.0);
  const double share = z_m > depth_m_ ? to_screen_m / way_m : 1;
  const double middle_m = start_x_m * (1 - share) + x_m * share;
  const double half_m = std::max(0.5 * aperture_m_ * (1 - share), kLeastWidth_m);
  const double amplitude = mean(middle_m - half_m, middle_m + half_m);
  if (passed < 1) return std::pow(amplitude, 4 * passed);
  return amplitude * amplitude * amplitude * amplitude;
}

}  // namespace echocine
