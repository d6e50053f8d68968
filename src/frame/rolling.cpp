#include "frame/rolling.h"

#include <algorithm>

#include "frame/picture_grid.h"
#include "scene/scan_geometry.h"

namespace echocine {

LineGroup lineGroup(LineRange lines, double offset_s, std::vector<int> taken) {
  const int count = static_cast<int>(taken.size());
  LineGroup group{lines, offset_s, {lines, std::move(taken)}, lines};
  const std::vector<int>& samples = group.traced.intensities;
  while (group.beams.first > 0 && samples[static_cast<std::size_t>(group.beams.first - 1)] > 0)
    --group.beams.first;
  while (group.beams.end < count && samples[static_cast<std::size_t>(group.beams.end)] > 0)
    ++group.beams.end;
  return group;
}

RollingLines::RollingLines(const Scene& scene,
                           const std::function<std::vector<int>(LineRange)>& taken)
    : lines_(scene.probe.lines), samples_(scene.probe.samples) {
  const double whole_s = scene.acquisition.rolling_share / scene.acquisition.frame_rate_hz;
  const int together = scene.accuracy.rolling_lines;
  for (int first = 0; first < lines_; first += together) {
    const LineRange lines{first, std::min(first + together, lines_)};
    // Exactly 0 of the middle: its instant is the frame's very time.
    const double from_middle = 0.5 * (lines.first + lines.end - lines_) / lines_;
    groups_.push_back(lineGroup(lines, from_middle * whole_s, taken(lines)));
  }
  if (!scene.truth.labels) return;
  const PictureGrid grid = pictureGrid(scene);
  const ScanGeometry geometry(scene.probe);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const double place = geometry.placeOf({grid.xOf(column), 0, grid.zOf(row)});
      const int line = geometry.nearestLine((place - geometry.firstPlace()) / geometry.cellWidth());
      group_of_pixel_.push_back(static_cast<std::uint16_t>(line / together));
    }
}

namespace {

// One value for each sample, line-major.
template <typename Plane>
void takeLines(LineRange lines, int samples, const Plane& from, Plane& to) {
  if (from.size() == 0) return;
  to.resize(from.size());
  const auto per_line = static_cast<std::ptrdiff_t>(samples);
  std::copy(from.begin() + lines.first * per_line, from.begin() + lines.end * per_line,
            to.begin() + lines.first * per_line);
}

}  // namespace

void RollingLines::take(std::size_t group, const PolarFrame& from, PolarFrame& to) const {
  const LineRange lines = groups_[group].lines;
  to.lines = from.lines;
  to.samples = from.samples;
  for (const auto& [channel, plane] : from.planes)
    takeLines(lines, samples_, plane, to.planes[channel]);
  takeLines(lines, samples_, from.medium, to.medium);
  takeLines(lines, samples_, from.intensities.values, to.intensities.values);
  takeLines(lines, samples_, from.field.mean, to.field.mean);
  takeLines(lines, samples_, from.field.real, to.field.real);
  takeLines(lines, samples_, from.field.imaginary, to.field.imaginary);
}

void RollingLines::take(std::size_t group, const FrameTruth& from, FrameTruth& to) const {
  const LineRange lines = groups_[group].lines;
  takeLines(lines, samples_, from.sample_ids, to.sample_ids);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    takeLines(lines, samples_, from.motion.displacement_mm[axis], to.motion.displacement_mm[axis]);
    takeLines(lines, samples_, from.motion.velocity_mm_s[axis], to.motion.velocity_mm_s[axis]);
  }
  takeLines(lines, samples_, from.motion.beam_m_s, to.motion.beam_m_s);
  to.picture_ids.resize(from.picture_ids.size());
  to.labels.resize(from.labels.size());
  for (std::size_t i = 0; i < from.picture_ids.size(); ++i) {
    if (group_of_pixel_[i] != group) continue;
    to.picture_ids[i] = from.picture_ids[i];
    to.labels[i] = from.labels[i];
  }
}

}  // namespace echocine
