#include "truth/motion_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/lanes.h"
#include "motion/interior/line_march.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// One line of the planes of a quantity, lateral, axial and elevation, while it is painted: from
// sample to sample, and each may spoil what a few lanes behind it are still to be.
using LinePlanes = std::array<std::vector<float>, 3>;

constexpr Floats8 kRamp{0, 1, 2, 3, 4, 5, 6, 7};

// The cubic that has a stretch's values and slopes at its ends, at the samples from `begin` to
// before `end`.
void putCubic(float from, float to, const LineMarch::Stretch& stretch, float scale,
              std::size_t begin, std::size_t end, LinePlanes& planes) {
  const float length = to - from, per = length > 0 ? 1 / length : 0;
  const auto put = [&](float Vec3f::*axis, std::vector<float>& plane) {
    const float a = scale * stretch.from.value_m.*axis, slope = scale * stretch.from.slope_m.*axis,
                slope_to = scale * stretch.to.slope_m.*axis,
                mean = (scale * stretch.to.value_m.*axis - a) * per;
    const float square = (3 * mean - 2 * slope - slope_to) * per,
                cube = (slope + slope_to - 2 * mean) * per * per;
    for (std::size_t k = begin; k < end; k += kFloatLanes) {
      const Floats8 u = kRamp + (static_cast<float>(k) - from);
      store(a + u * (slope + u * (square + u * cube)), &plane[k]);
    }
  };
  put(&Vec3f::x, planes[0]);
  put(&Vec3f::z, planes[1]);
  put(&Vec3f::y, planes[2]);
}

// Samples of one structure along one line.
struct SampleRun {
  std::size_t begin, end;
};

class LinePainter {
 public:
  LinePainter(const FieldTimes& times, bool velocity, std::size_t samples)
      : times_(times), velocity_(velocity), offsets_m_(times.now.groups.size()) {
    for (std::vector<float>& plane : displacement_mm_) plane.resize(samples + kFloatLanes);
    if (velocity)
      for (std::vector<float>& plane : velocity_mm_s_) plane.resize(samples + kFloatLanes);
    if (velocity) beam_m_s_.resize(samples);
  }

  // start_m, step_m: of the line, from sample to sample.
  void paint(GroupId group, const SampleRun& run, Vec3d start_m, Vec3d step_m) {
    if (times_.now[group].displacement_m.empty()) return fill(run, 0);
    LineMarch march(times_.now[group], start_m, step_m);
    for (std::size_t k = run.begin; k < run.end; ++k) {
      if (start(march, group, k, start_m + static_cast<double>(k) * step_m))
        k = follow(march, group, k, run.end);
      if (k < run.end) fill({k, k + 1}, std::numeric_limits<float>::quiet_NaN());
    }
  }

  void fill(const SampleRun& run, float value) {
    for (LinePlanes* const planes : {&displacement_mm_, &velocity_mm_s_})
      for (std::vector<float>& plane : *planes)
        if (!plane.empty()) std::fill(&plane[run.begin], &plane[run.end], value);
  }

  // The part of the velocity along the sound's path; step_m: away from the probe.
  void project(const SampleRun& run, Vec3d step_m) {
    if (!velocity_) return;
    const Vec3f towards = toFloat((-1e-3 / length(step_m)) * step_m);
    for (std::size_t k = run.begin; k < run.end; ++k)
      beam_m_s_[k] = towards.x * velocity_mm_s_[0][k] + towards.z * velocity_mm_s_[1][k] +
                     towards.y * velocity_mm_s_[2][k];
  }

  void append(MotionPlanes& planes) const {
    for (std::size_t i = 0; i < 3; ++i) {
      append(displacement_mm_[i], planes.displacement_mm[i]);
      if (velocity_) append(velocity_mm_s_[i], planes.velocity_mm_s[i]);
    }
    planes.beam_m_s.insert(planes.beam_m_s.end(), beam_m_s_.begin(), beam_m_s_.end());
  }

 private:
  static void append(const std::vector<float>& line, std::vector<float>& plane) {
    plane.insert(plane.end(), line.begin(), line.end() - kFloatLanes);
  }

  // The guess is how the group's last run began, which is mostly the line's before; what is found
  // far from it is sought from the place itself.
  bool start(LineMarch& march, GroupId group, std::size_t k, Vec3d place_m) {
    const auto at = static_cast<float>(k);
    Vec3f& offset_m = offsets_m_[index(group)];
    const Vec3f place = toFloat(place_m);
    const auto offset = [&] { return -march.moved().to.value_m; };
    const bool near = march.startAt(at, place + offset_m) &&
                      length(offset() - offset_m) < times_.now[group].grid.spacing_m;
    if (!near && !march.startAt(at, place)) return false;
    offset_m = offset();
    return true;
  }

  // Fills from sample k on while the field says where the material was. Returns the first sample
  // that is not filled.
  std::size_t follow(LineMarch& march, GroupId group, std::size_t k, std::size_t end) {
    const auto last = static_cast<float>(end - 1);
    while (k < end && march.advance(last)) {
      const auto reached = march.to() < last ? static_cast<std::size_t>(march.to()) + 1 : end;
      if (reached > k) put(march, group, k, reached);
      k = std::max(k, reached);
    }
    return k;
  }

  void put(const LineMarch& march, GroupId group, std::size_t begin, std::size_t end) {
    LineMarch::Stretch moved = march.moved();
    if (times_.first != nullptr) {
      const LineMarch::Stretch first = march.in((*times_.first)[group]);
      moved = {moved.from - first.from, moved.to - first.to};
    }
    putCubic(march.from(), march.to(), moved, 1e3f, begin, end, displacement_mm_);
    if (velocity_)
      putCubic(march.from(), march.to(), march.between(times_.before[group], times_.after[group]),
               static_cast<float>(1e3 / times_.seconds), begin, end, velocity_mm_s_);
  }

  const FieldTimes& times_;
  bool velocity_;
  LinePlanes displacement_mm_, velocity_mm_s_;
  std::vector<float> beam_m_s_;
  std::vector<Vec3f> offsets_m_;  // by group: from a place to its reference
};

// By structure, from 1: blood and what is no body have no motion of their own.
std::vector<bool> tissueOf(const Scene& scene) {
  std::vector<bool> tissue{false};
  for (const Structure& s : scene.structures)
    tissue.push_back(!s.membrane && !scene.medium(s.medium).blood);
  return tissue;
}

// The first sample behind `begin` that is of another structure.
std::size_t runEnd(std::span<const std::uint32_t> ids, std::size_t begin) {
  constexpr std::size_t kTogether = 16;
  const std::uint32_t id = ids[begin];
  std::size_t end = begin + 1;
  for (; end + kTogether <= ids.size(); end += kTogether) {
    std::uint32_t others = 0;
    for (std::size_t i = 0; i < kTogether; ++i) others |= ids[end + i] ^ id;
    if (others != 0) break;
  }
  while (end < ids.size() && ids[end] == id) ++end;
  return end;
}

// Samples that stand evenly on a straight piece: sample k at start + k step, up to before `end`.
struct StraightPiece {
  Vec3d start_m, step_m;
  std::size_t end = 0;
};

StraightPiece wholeLine(const Probe& probe, int line) {
  const LineGeometry along = lineGeometry(probe, line);
  const double spacing_m = probe.sampleSpacing();
  return {along.origin + (probe.min_depth_m + 0.5 * spacing_m) * along.direction,
          spacing_m * along.direction, static_cast<std::size_t>(probe.samples)};
}

// The piece that holds sample k.
StraightPiece pieceFrom(const SoundPath& path, const Probe& probe, std::size_t k) {
  const ScanGeometry geometry(probe);
  const auto depth = [&](std::size_t sample) {
    return geometry.sampleDepth(static_cast<int>(sample));
  };
  const std::size_t at = path.pieceAt(depth(k));
  const SoundPath::Knot &a = path.knots[at], &b = path.knots[at + 1];
  const double run_m = b.depth_m - a.depth_m;
  const Vec3d per_depth = run_m > 0 ? (1 / run_m) * (b.place_m - a.place_m) : Vec3d{};
  StraightPiece piece{a.place_m + (depth(0) - a.depth_m) * per_depth,
                      probe.sampleSpacing() * per_depth, k + 1};
  const bool last = at + 2 == path.knots.size();
  const auto samples = static_cast<std::size_t>(probe.samples);
  while (piece.end < samples && (last || depth(piece.end) < b.depth_m)) ++piece.end;
  return piece;
}

}  // namespace

std::vector<bool> tissueGroups(const Scene& scene, const MotionField& field) {
  std::vector<bool> groups(field.groupCount(), false);
  const std::vector<bool> tissue = tissueOf(scene);
  for (std::size_t s = 0; s < scene.structures.size(); ++s)
    if (tissue[s + 1]) groups[index(field.groupOf(static_cast<SurfaceId>(s)))] = true;
  return groups;
}

void motionPlanes(const Scene& scene, const MotionField& field, const FieldTimes& times,
                  std::span<const std::uint32_t> ids, bool velocity, const SoundPaths* paths,
                  MotionPlanes& planes) {
  const auto samples = static_cast<std::size_t>(scene.probe.samples);
  for (std::size_t i = 0; i < 3; ++i) {
    planes.displacement_mm[i].clear();
    planes.displacement_mm[i].reserve(ids.size());
    planes.velocity_mm_s[i].clear();
    if (velocity) planes.velocity_mm_s[i].reserve(ids.size());
  }
  planes.beam_m_s.clear();
  const std::vector<bool> tissue = tissueOf(scene);
  LinePainter painter(times, velocity, samples);
  for (std::size_t first = 0; first < ids.size(); first += samples) {
    const std::size_t line = first / samples;
    const SoundPath* const path = paths ? &paths->paths[paths->pathOfLine(line)] : nullptr;
    StraightPiece piece = wholeLine(scene.probe, static_cast<int>(line));
    const std::span<const std::uint32_t> of_line = ids.subspan(first, samples);
    for (std::size_t begin = 0, end = 0; begin < samples; begin = end) {
      const std::uint32_t id = of_line[begin];
      end = runEnd(of_line, begin);
      if (path) {
        piece = pieceFrom(*path, scene.probe, begin);
        end = std::min(end, piece.end);
      }
      if (tissue[id])
        painter.paint(field.groupOf(static_cast<SurfaceId>(id - 1)), {begin, end}, piece.start_m,
                      piece.step_m);
      else
        painter.fill({begin, end}, std::numeric_limits<float>::quiet_NaN());
      painter.project({begin, end}, piece.step_m);
    }
    painter.append(planes);
  }
}

}  // namespace echocine
