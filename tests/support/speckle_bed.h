#pragma once
// A bed of scatterers without a heart about it: one group, moved by an affine map.

#include <cmath>
#include <vector>

#include "core/units.h"
#include "speckle/speckle.h"
#include "support/plain_scene.h"

namespace echocine::support {

struct Affine : MaterialFrame {
  Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, shift{};  // columns
  std::vector<Vec3f> on_sheets_m;
  std::span<const Vec3f> onSheets() const override { return on_sheets_m; }

  CubeCorners corners(std::uint16_t, Vec3f low_m, float edge_m) const override {
    CubeCorners out;
    for (std::size_t c = 0; c < out.size(); ++c) {
      const Vec3d p =
          toDouble(low_m) +
          static_cast<double>(edge_m) * Vec3d{c & 1 ? 1.0 : 0, c & 2 ? 1.0 : 0, c & 4 ? 1.0 : 0};
      out[c] = toFloat(p.x * x + p.y * y + p.z * z + shift);
    }
    return out;
  }
};

inline Affine shifted(Vec3d shift) {
  Affine map;
  map.shift = shift;
  return map;
}

// About the elevation's axis, from z towards x.
inline Affine turned(double angle_rad) {
  Affine map;
  map.x = {std::cos(angle_rad), 0, -std::sin(angle_rad)};
  map.z = {std::sin(angle_rad), 0, std::cos(angle_rad)};
  return map;
}

// Stretched along the depth by a strain that leaves a depth where it is.
inline Affine stretched(double strain, double about_m) {
  Affine map;
  map.z = {0, 0, 1 + strain};
  map.shift = {0, 0, -strain * about_m};
  return map;
}

struct OneGroup : Material {
  bool flows = false;
  double reach_m = 0.006;
  bool blood(std::uint16_t) const override { return flows; }
  double reachAcross_m() const override { return reach_m; }
  double reachAlong_m() const override { return reach_m; }
};

inline Probe speckleProbe(ProbeKind kind, int lines, int samples, double from_m, double to_m) {
  Probe probe = plainScene({medium("tissue", 1050, 1540)}).probe;
  probe.kind = kind;
  probe.lines = lines;
  probe.samples = samples;
  probe.min_depth_m = from_m;
  probe.max_depth_m = to_m;
  const double half_rad = 0.5 * radiansFromDegrees(0.3) * (lines - 1);
  probe.first_angle_rad = -half_rad;
  probe.last_angle_rad = half_rad;
  if (kind == ProbeKind::curvilinear) probe.face_radius_m = 0.05;
  if (kind == ProbeKind::linear) {
    probe.first_angle_rad = probe.last_angle_rad = 0;
    probe.last_offset_m = 0.00025 * (lines - 1);
    probe.first_offset_m = -probe.last_offset_m;
  }
  return probe;
}

struct SpeckleBed {
  Probe probe;
  SpeckleSettings settings;
  OneGroup material;

  SpeckleBed(ProbeKind kind, int lines, int samples, double from_m, double to_m)
      : probe(speckleProbe(kind, lines, samples, from_m, to_m)) {
    settings.smoothing_m = 0;
  }

  Speckle speckle() const { return Speckle(probe, PointSpread(probe, 2), settings, material); }
  std::size_t size() const {
    return static_cast<std::size_t>(probe.lines) * static_cast<std::size_t>(probe.samples);
  }
  std::vector<float> even(float intensity = 1) const {
    return std::vector<float>(size(), intensity);
  }
  std::vector<float> picture(const Speckle& speckle, const MaterialFrame& tissue = Affine{},
                             double time_s = 0) const {
    std::vector<float> intensities = even();
    speckle.apply(tissue, time_s, intensities);
    return intensities;
  }
};

// Correlation of a's samples with those of b that lie `lines` and `samples` on, over a window.
struct Window {
  int first_line, last_line, first_sample, last_sample;
};
inline double correlation(const std::vector<float>& a, const std::vector<float>& b, int per_line,
                          const Window& w, int lines = 0, int samples = 0) {
  double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
  for (int i = w.first_line; i < w.last_line; ++i)
    for (int k = w.first_sample; k < w.last_sample; ++k) {
      const double x = a[static_cast<std::size_t>(i * per_line + k)];
      const double y = b[static_cast<std::size_t>((i + lines) * per_line + k + samples)];
      n += 1;
      sa += x;
      sb += y;
      saa += x * x;
      sbb += y * y;
      sab += x * y;
    }
  return (sab - sa * sb / n) / std::sqrt((saa - sa * sa / n) * (sbb - sb * sb / n));
}

// Full width at half maximum, in lags, of a correlation by lag from 0 on: between two lags as a
// Gaussian falls, linear in lag^2 and the logarithm.
inline double widthAtHalf(const std::vector<double>& by_lag) {
  std::size_t lag = 1;
  while (lag + 1 < by_lag.size() && by_lag[lag] > 0.5) ++lag;
  const double at = static_cast<double>(lag), x0 = (at - 1) * (at - 1), x1 = at * at;
  const double y0 = std::log(by_lag[lag - 1]), y1 = std::log(by_lag[lag]);
  return 2 * std::sqrt(x0 + (x1 - x0) * (y0 - std::log(0.5)) / (y0 - y1));
}

}  // namespace echocine::support
