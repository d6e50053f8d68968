#include "truth/motion_planes.h"
#include "scene/scan_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echocine {

namespace {

// Along a line the motion is found at every so many samples of one structure, and linear between:
// finer than the field's own lattice. Our choice.
constexpr std::size_t kStride = 12;

// Displacement and velocity of the material at a place, mm and mm/s.
struct Motion {
  Vec3f displacement_mm, velocity_mm_s;
};

class LineMotion {
 public:
  LineMotion(const Scene& scene, const MotionField& field, const FieldTimes& times, bool velocity)
      : field_(field), times_(times), velocity_(velocity) {
    for (const Structure& s : scene.structures)
      tissue_.push_back(!s.membrane &&
                        scene.medium(s.medium).name.find("blood") == std::string::npos);
  }

  bool isTissue(std::uint32_t id) const { return id > 0 && tissue_[id - 1]; }

  // The guess is the last place's, which is near.
  std::optional<Motion> at(std::uint32_t id, Vec3f place_m) {
    const GroupId group = field_.groupOf(static_cast<SurfaceId>(id - 1));
    if (group_ != group) offset_m_ = {};
    group_ = group;
    auto reference = times_.now[group].reference(place_m, place_m + offset_m_);
    if (!reference) reference = times_.now[group].reference(place_m, place_m);
    if (!reference) return std::nullopt;
    offset_m_ = *reference - place_m;
    const Vec3f moved = place_m - times_.reference[group].place(*reference);
    Vec3f run;
    if (velocity_)
      run = times_.after[group].place(*reference) - times_.before[group].place(*reference);
    return Motion{1e3f * moved, static_cast<float>(1e3 / times_.seconds) * run};
  }

 private:
  const MotionField& field_;
  const FieldTimes& times_;
  bool velocity_;
  std::vector<bool> tissue_;
  std::optional<GroupId> group_;
  Vec3f offset_m_;
};

// `count` samples from `left` on, straight towards `right`, which is the one after them.
void put(std::array<std::vector<float>, 3>& planes, std::size_t at, std::size_t count, Vec3f left,
         Vec3f right) {
  const Vec3f step = (1 / static_cast<float>(count)) * (right - left);
  const auto along = [&](std::vector<float>& plane, float value, float more) {
    for (std::size_t i = 0; i < count; ++i) plane[at + i] = value + static_cast<float>(i) * more;
  };
  along(planes[0], left.x, step.x);
  along(planes[1], left.z, step.z);
  along(planes[2], left.y, step.y);
}

}  // namespace

void motionPlanes(const Scene& scene, const MotionField& field, const FieldTimes& times,
                  std::span<const std::uint32_t> ids, bool velocity, MotionPlanes& planes) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  for (auto& plane : planes.displacement_mm) plane.assign(ids.size(), kUnknown);
  for (auto& plane : planes.velocity_mm_s) plane.assign(velocity ? ids.size() : 0, kUnknown);
  const auto samples = static_cast<std::size_t>(scene.probe.samples);
  LineMotion motion(scene, field, times, velocity);
  for (std::size_t first = 0; first < ids.size(); first += samples) {
    const LineGeometry line = lineGeometry(scene.probe, static_cast<int>(first / samples));
    const auto placeOf = [&](std::size_t k) {
      const double path_m =
          scene.probe.min_depth_m + (static_cast<double>(k) + 0.5) * scene.probe.sampleSpacing();
      return toFloat(line.origin + path_m * line.direction);
    };
    for (std::size_t begin = 0, end = 0; begin < samples; begin = end) {
      const std::uint32_t id = ids[first + begin];
      for (end = begin + 1; end < samples && ids[first + end] == id;) ++end;
      if (!motion.isTissue(id)) continue;
      std::optional<Motion> left = motion.at(id, placeOf(begin));
      for (std::size_t k = begin; k < end;) {
        const std::size_t next = std::min(k + kStride, end - 1);
        const std::optional<Motion> right = next > k ? motion.at(id, placeOf(next)) : left;
        const std::size_t count = std::max(next - k, std::size_t{1});  // the last sample by itself
        if (left && right) {
          put(planes.displacement_mm, first + k, count, left->displacement_mm,
              right->displacement_mm);
          if (velocity)
            put(planes.velocity_mm_s, first + k, count, left->velocity_mm_s, right->velocity_mm_s);
        }
        if (next == k) break;
        k = next;
        left = right;
      }
    }
  }
}

}  // namespace echocine
