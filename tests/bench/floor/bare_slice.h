#pragma once
// The floor of the plane slice: cut and march with nothing but what any such loop must do. No rule
// for ties, no priorities, no media, no echoes: a measure, not a tracer.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "bench/bench_scene.h"
#include "scene/scan_geometry.h"

namespace echocine::bench {

class BareSlice {
 public:
  explicit BareSlice(const BenchScene& scene)
      : scene_(scene),
        samples_(scene.scene.probe.samples),
        lines_(static_cast<std::size_t>(scene.scene.probe.lines)),
        plane_(lines_.size() * static_cast<std::size_t>(samples_)) {
    const Probe& p = scene.scene.probe;
    for (int i = 0; i < p.lines; ++i) {
      const LineGeometry line = lineGeometry(p, i);
      sin_.push_back(static_cast<float>(line.direction.x));
      cos_.push_back(static_cast<float>(line.direction.z));
    }
  }

  // The crossings of every line.
  void slice(const SurfaceFrame& frame) {
    for (auto& line : lines_) line.clear();
    for (const SurfaceTopology& surface : scene_.topology)
      cut(surface, frame.positions_m[index(surface.id)]);
  }
  // Their samples; after slice().
  std::vector<float>& fill() {
    for (std::size_t i = 0; i < lines_.size(); ++i) march(i);
    return plane_;
  }

 private:
  void cut(const SurfaceTopology& surface, const std::vector<Vec3f>& p) {
    above_.resize(p.size());
    std::uint8_t* above = above_.data();
    const std::size_t vertices = p.size();
    for (std::size_t v = 0; v < vertices; ++v) above[v] = p[v].y >= 0;
    for (const Triangle& t : surface.triangles) {
      const int sides = above[t[0]] + above[t[1]] + above[t[2]];
      if (sides == 0 || sides == 3) continue;
      const int k = above[t[1]] == above[t[2]] ? 0 : above[t[0]] == above[t[2]] ? 1 : 2;
      const Vec3f a = p[t[static_cast<std::size_t>(k)]],
                  b = p[t[static_cast<std::size_t>((k + 1) % 3)]],
                  c = p[t[static_cast<std::size_t>((k + 2) % 3)]];
      const float s = a.y / (a.y - b.y), r = a.y / (a.y - c.y);
      spread(a.x + s * (b.x - a.x), a.z + s * (b.z - a.z), a.x + r * (c.x - a.x),
             a.z + r * (c.z - a.z), static_cast<float>(index(surface.id)));
    }
  }

  void spread(float x1, float z1, float x2, float z2, float id) {
    const Probe& p = scene_.scene.probe;
    const auto last = static_cast<float>(p.lines - 1);
    const auto place = [&](float x, float z) {
      return (std::atan2(x, z) - static_cast<float>(p.first_angle_rad)) * last /
             static_cast<float>(p.last_angle_rad - p.first_angle_rad);
    };
    const float q1 = place(x1, z1), q2 = place(x2, z2);
    const int begin = std::max(static_cast<int>(std::ceil(std::min(q1, q2))), 0);
    const int end =
        std::min(static_cast<int>(std::floor(std::max(q1, q2))), static_cast<int>(last));
    for (int i = begin; i <= end; ++i) {
      const auto line = static_cast<std::size_t>(i);
      const float u1 = x1 * cos_[line] - z1 * sin_[line], u2 = x2 * cos_[line] - z2 * sin_[line];
      const float w1 = x1 * sin_[line] + z1 * cos_[line], w2 = x2 * sin_[line] + z2 * cos_[line];
      lines_[line].push_back({(w1 * u2 - w2 * u1) / (u2 - u1), id});
    }
  }

  // Sorted crossings, then attenuated backscatter by stored powers, eight samples at a time.
  void march(std::size_t i) {
    auto& line = lines_[i];
    std::sort(line.begin(), line.end());
    float* out = plane_.data() + i * static_cast<std::size_t>(samples_);
    const float spacing = 0.158f / static_cast<float>(samples_);
    int k = 0;
    float passed = 1;
    for (std::size_t c = 0; c <= line.size(); ++c) {
      const float to = c < line.size() ? line[c].first : 1;
      const int end = std::clamp(static_cast<int>((to - 0.002f) / spacing), k, samples_);
      const float factor = std::exp(-4 * (c % 2 ? 4.0f : 14.0f) * spacing);
      Eight power{}, offset{};
      float eighth = 1;
      for (int j = 0; j < 8; ++j) {
        power[j] = eighth;
        offset[j] = static_cast<float>(j) * spacing;
        eighth *= factor;
      }
      for (; k < end; k += std::min(8, end - k)) {
        const Eight l = offset + (0.002f + (static_cast<float>(k) + 0.5f) * spacing);
        const Eight value = passed * power / (l * l);
        std::memcpy(out + k, &value,
                    (end - k < 8 ? static_cast<std::size_t>(end - k) : 8) * sizeof(float));
        passed *= eighth;
      }
      passed *= 0.999f;
    }
  }

  using Eight = float __attribute__((vector_size(32)));
  const BenchScene& scene_;
  int samples_;
  std::vector<std::vector<std::pair<float, float>>> lines_;
  std::vector<float> plane_, sin_, cos_;
  std::vector<std::uint8_t> above_;
};

}  // namespace echocine::bench
