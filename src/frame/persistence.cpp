#include "frame/persistence.h"

#include <cmath>
#include <iterator>

namespace echocine {

namespace {

constexpr double kForgotten = 1.0 / 64;  // our choice: four grey levels of 255 at most
constexpr std::size_t kSpare = 16;       // kept frames beyond the window: those in flight

}  // namespace

Persistence::Persistence(double weight, const CardiacClock& clock, double frame_rate_hz)
    : clock_(clock), frame_rate_hz_(frame_rate_hz) {
  for (double w = 1; w >= kForgotten; w *= weight) weights_.push_back(static_cast<float>(w));
}

bool Persistence::ofLoop(const FrameTime& time) const {
  return time.frame >= 0 && time.frame < clock_.frameCount() &&
         clock_.at(time.frame).time_s == time.time_s;
}

std::vector<FrameTime> Persistence::before(const FrameTime& time) const {
  std::vector<FrameTime> list;
  const bool of_loop = ofLoop(time);
  for (int j = 1; j <= depth(); ++j) {
    const double earlier_s = time.time_s - j / frame_rate_hz_;
    if (of_loop ? time.frame < j : earlier_s < 0) break;
    FrameTime earlier = of_loop ? clock_.at(time.frame - j) : clock_.atTime(earlier_s);
    if (!of_loop) earlier.frame = static_cast<int>(std::floor(earlier_s * frame_rate_hz_));
    list.push_back(earlier);
  }
  return list;
}

Persistence::Kept Persistence::known(double reference_intensity, int frame) const {
  const std::lock_guard lock(mutex_);
  const auto found = kept_.find(frame);
  return reference_ == reference_intensity && found != kept_.end() ? found->second : nullptr;
}

// The frame that is farthest away makes room.
void Persistence::keep(double reference_intensity, int frame, Kept greys) const {
  const std::lock_guard lock(mutex_);
  if (reference_ != reference_intensity) kept_.clear();
  reference_ = reference_intensity;
  kept_[frame] = std::move(greys);
  if (kept_.size() <= weights_.size() + kSpare) return;
  const bool first = frame - kept_.begin()->first > kept_.rbegin()->first - frame;
  kept_.erase(first ? kept_.begin() : std::prev(kept_.end()));
}

void Persistence::apply(double reference_intensity, const FrameTime& time, Greys& greys,
                        const Alone& alone) const {
  const auto greysOf = [&](const FrameTime& earlier) {
    Kept kept = ofLoop(earlier) ? known(reference_intensity, earlier.frame) : nullptr;
    if (kept) return kept;
    kept = std::make_shared<const Greys>(alone(earlier));
    if (ofLoop(earlier)) keep(reference_intensity, earlier.frame, kept);
    return kept;
  };
  if (ofLoop(time)) keep(reference_intensity, time.frame, std::make_shared<const Greys>(greys));
  float sum = 1;
  std::size_t j = 1;
  for (const FrameTime& earlier : before(time)) {
    const Kept old = greysOf(earlier);
    const float weight = weights_[j++];
    sum += weight;
    for (std::size_t i = 0; i < greys.size(); ++i) greys[i] += weight * (*old)[i];
  }
  const float scale = 1 / sum;
  for (float& grey : greys.values) grey *= scale;
}

}  // namespace echocine
