#include "loop/kept_frames.h"

namespace echocine {

namespace {

// Size of a kept frame: its planes, by far the largest part.
std::size_t bytesOf(const PolarFrame& polar) {
  const std::size_t planes = polar.planes.size() + (polar.intensities.empty() ? 0 : 1) +
                             (polar.medium.empty() ? 0 : 1) + (polar.field.empty() ? 0 : 3);
  return planes * sizeof(float) * static_cast<std::size_t>(polar.lines) *
         static_cast<std::size_t>(polar.samples);
}

}  // namespace

void KeptFrames::keep(int frame, PolarFrame&& polar, Volumes&& volumes_ml) {
  if (frame < range_.first || frame >= range_.second) return;
  bytes_ += bytesOf(polar);
  if (bytes_ > kKeptBytes) return;
  // Only what the signal chain still needs.
  polar.traces.clear();
  polar.cell_echoes = {};
  polar.coherent = {};
  frames_.emplace(frame, Kept{std::move(polar), std::move(volumes_ml)});
}

bool KeptFrames::take(int frame, PolarFrame& polar, Volumes& volumes_ml) {
  const std::lock_guard lock(mutex_);
  const auto found = frames_.find(frame);
  if (found == frames_.end()) return false;
  polar = std::move(found->second.polar);
  volumes_ml = std::move(found->second.volumes_ml);
  frames_.erase(found);  // its memory is free from here on
  return true;
}

}  // namespace echocine
