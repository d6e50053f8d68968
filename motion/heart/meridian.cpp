#include "motion/heart/meridian.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine::heart {
namespace {

constexpr int kArcSteps = 1024, kFineSteps = 8192;

}  // namespace

Meridian::Meridian(std::vector<std::pair<double, double>> squares) : square_(squares) {
  const double low = squares.front().first, high = squares.back().first;
  // Sampled evenly by angle, densely where the outline closes.
  std::vector<Point> fine(kFineSteps + 1);
  std::vector<double> arc(fine.size(), 0);
  for (int i = 0; i <= kFineSteps; ++i) {
    const double cos_angle = std::cos(std::numbers::pi * i / kFineSteps);
    const double zeta = 0.5 * (low + high) + 0.5 * (high - low) * cos_angle;
    fine[i] = {zeta, rhoAt(zeta)};
    if (i == 0) continue;
    const double fall = fine[i - 1].zeta - zeta;
    arc[i] = arc[i - 1] + std::hypot(fall, fine[i].rho - fine[i - 1].rho);
    volume_ += std::numbers::pi * fall *
               (fine[i].rho * fine[i].rho + fine[i - 1].rho * fine[i - 1].rho) / 2;
    widest_ = std::max(widest_, fine[i].rho);
  }
  for (int step = 0; step <= kArcSteps; ++step) {
    const double want = arc.back() * step / kArcSteps;
    const auto above = std::upper_bound(arc.begin() + 1, arc.end() - 1, want);
    const auto i = static_cast<std::size_t>(above - arc.begin());
    const double t = std::clamp((want - arc[i - 1]) / (arc[i] - arc[i - 1]), 0.0, 1.0);
    points_.push_back(
        {std::lerp(fine[i - 1].zeta, fine[i].zeta, t), std::lerp(fine[i - 1].rho, fine[i].rho, t)});
  }
}

Meridian::Point Meridian::at(double share) const {
  const double step = std::clamp(share, 0.0, 1.0) * kArcSteps;
  const int i = std::min(static_cast<int>(step), kArcSteps - 1);
  return {std::lerp(points_[i].zeta, points_[i + 1].zeta, step - i),
          std::lerp(points_[i].rho, points_[i + 1].rho, step - i)};
}

}  // namespace echocine::heart
