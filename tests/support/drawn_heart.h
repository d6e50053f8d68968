#pragma once
// A heart of two ellipses: what a model says of it, and how a scanner might show it.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "core/units.h"
#include "echo/echo_loop.h"
#include "fit/model_discrepancy.h"
#include "fit/plane_cells.h"

namespace echocine::support {

using namespace echo;
using namespace fit;

inline constexpr double kDepth_m = 0.15, kMiddle_m = kDepth_m / 2;
inline constexpr int kFrames = kFitFrames;

// Two chambers of blood in muscle, in a background of its own; the larger one beats.
struct Phantom {
  double grow_m = 0;  // of the larger chamber
  double beat = 0.15;

  static constexpr double kX = 0.006, kZ = 0.075, kTilt = 0.3, kWall_m = 0.010;
  double factor(double phase) const {
    return 1 - beat * 0.5 * (1 - std::cos(2 * std::numbers::pi * phase));
  }
  std::array<double, 2> axes(double phase) const {
    return {0.022 * factor(phase) + grow_m, 0.038 * factor(phase) + grow_m};
  }
  // Below 1 inside an ellipse grown by `more`.
  static double ellipse(double x, double z, std::array<double, 2> axes, double more) {
    const double c = std::cos(kTilt), s = std::sin(kTilt), u = c * (x - kX) + s * (z - kZ),
                 v = -s * (x - kX) + c * (z - kZ);
    return std::hypot(u / (axes[0] + more), v / (axes[1] + more));
  }
  // 0 background, 1 muscle, 2 blood.
  int tissue(double x, double z, double phase) const {
    if (ellipse(x, z, axes(phase), 0) < 1) return 2;
    const double other = std::hypot(x + 0.034, z - 0.1);
    if (other < 0.013) return 2;
    if (ellipse(x, z, axes(phase), kWall_m) < 1 || other < 0.018) return 1;
    return 0;
  }

  ModelLoop model() const {
    ModelLoop loop;
    loop.tissues = {"outside", "myocardium", "blood"};
    loop.blood = {false, false, true};
    loop.structures = {"larger", "smaller"};
    loop.far_m = kDepth_m;
    loop.cells_across = kCellLines;
    loop.cells_along = kCellsAlong;
    for (int n = 0; n < kFrames; ++n) {
      loop.frames.push_back(frame(static_cast<double>(n) / kFrames));
      weighByBlood(loop, loop.frames.back());
    }
    return loop;
  }

 private:
  ModelFrame frame(double phase) const {
    ModelFrame out;
    for (int i = 0; i < kCellLines; ++i)
      for (int k = 0; k < kCellsAlong; ++k) {
        const double angle = radiansFromDegrees(-40 + 80.0 * i / (kCellLines - 1)),
                     r = kDepth_m * (k + 0.5) / kCellsAlong;
        TissueCell cell;
        cell.x_m = static_cast<float>(r * std::sin(angle));
        cell.z_m = static_cast<float>(r * std::cos(angle));
        cell.area = static_cast<float>(r / kDepth_m);
        int counts[3] = {};
        for (int s = 0; s < 8; ++s) {
          const double rs = r + kDepth_m / kCellsAlong * ((s + 0.5) / 8 - 0.5);
          ++counts[tissue(rs * std::sin(angle), rs * std::cos(angle), phase)];
        }
        int first = 0;
        for (int t = 1; t < 3; ++t)
          if (counts[t] > counts[first]) first = t;
        int second = first == 0 ? 1 : 0;
        for (int t = 0; t < 3; ++t)
          if (t != first && counts[t] > counts[second]) second = t;
        cell.first = static_cast<std::uint8_t>(first);
        cell.second = static_cast<std::uint8_t>(counts[second] > 0 ? second : first);
        cell.share = static_cast<float>(counts[first]) /
                     static_cast<float>(counts[first] + (counts[second] > 0 ? counts[second] : 0));
        out.cells.push_back(cell);
      }
    addBoundary(phase, out);
    return out;
  }
  Vec3d pointAt(double turn, double phase) const {
    const auto [a, b] = axes(phase);
    const double u = a * std::cos(turn), v = b * std::sin(turn), c = std::cos(kTilt),
                 s = std::sin(kTilt);
    return {kX + c * u - s * v, 0, kZ + s * u + c * v};
  }
  void addBoundary(double phase, ModelFrame& out) const {
    constexpr int kPieces = 160;
    for (int i = 0; i < kPieces; ++i) {
      const double at = 2 * std::numbers::pi * i / kPieces, step = std::numbers::pi / kPieces;
      const Vec3d p = pointAt(at, phase), next = pointAt(at, phase + 1.0 / kFrames),
                  along = pointAt(at + step, phase) - pointAt(at - step, phase);
      const double length = std::hypot(along.x, along.z);
      BoundaryPoint piece;
      piece.x_m = static_cast<float>(p.x), piece.z_m = static_cast<float>(p.z);
      piece.nx = static_cast<float>(along.z / length);
      piece.nz = static_cast<float>(-along.x / length);
      piece.length_m = static_cast<float>(length);
      piece.dx_m = static_cast<float>(next.x - p.x), piece.dz_m = static_cast<float>(next.z - p.z);
      piece.of_blood = true;
      piece.blood = 2, piece.beside = 1;
      out.boundary.push_back(piece);
    }
  }
};

// The phantom as a scanner might show it: one grey for each tissue, a gain over depth, speckle that
// moves with nothing, all moved by a pose. It is smallest at `systole` of the beat.
inline EchoLoop draw(const Phantom& phantom, const FitPose& pose, int frames, std::uint64_t seed,
                     double start_phase = 0, double systole = 0.5) {
  constexpr int kWidth = 250, kHeight = 190;
  constexpr double kPixel_m = 0.8e-3;
  constexpr double kGrey[3] = {95, 150, 35};
  EchoLoop loop;
  loop.video.name = "drawn";
  loop.video.width = kWidth;
  loop.video.height = kHeight;
  loop.metres_per_pixel = kPixel_m;
  loop.frames_per_beat = frames;
  loop.find.sector = {125, 1, radiansFromDegrees(-41), radiansFromDegrees(41), 3, 185};
  loop.overlay.assign(static_cast<std::size_t>(kWidth * kHeight), 0);
  const double c = std::cos(pose.turn_rad) / pose.scale, s = std::sin(pose.turn_rad) / pose.scale;
  for (int n = 0; n < frames; ++n) {
    PixelPlane plane;
    for (int j = 0; j < kHeight; ++j)
      for (int i = 0; i < kWidth; ++i) {
        const double rx = (i + 0.5 - 125) * kPixel_m - pose.shift_x_m,
                     rz = (j + 0.5 - 1) * kPixel_m - kMiddle_m - pose.shift_z_m;
        const double x = c * rx - s * rz, z = kMiddle_m + s * rx + c * rz;
        const std::uint64_t where =
            hashOf(seed, static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j));
        const double speckle = normalFromHashes(hashOf(where, 1, 0), hashOf(where, 2, 0));
        const double grey =
            kGrey[phantom.tissue(
                x, z, warpedPhase(start_phase + static_cast<double>(n) / frames, systole, 0.5))] +
            30 * (rz + kMiddle_m) / kDepth_m + 18 * speckle;
        plane.push_back(static_cast<std::uint8_t>(std::clamp(grey, 0.0, 255.0)));
      }
    loop.video.frames.push_back(std::move(plane));
  }
  return loop;
}

// The loop's first frame is end-diastole.
inline SideOptions fromTheStart() {
  SideOptions side;
  side.ed_frame = 0;
  return side;
}

// What of a frame of a model is blood, in the unit of its cells.
inline double bloodOf(const ModelLoop& loop, std::size_t frame) {
  double area = 0;
  for (const TissueCell& cell : loop.frames[frame].cells)
    area += static_cast<double>(cell.area) *
            ((loop.blood[cell.first] ? static_cast<double>(cell.share) : 0) +
             (loop.blood[cell.second] ? 1 - static_cast<double>(cell.share) : 0));
  return area;
}

}  // namespace echocine::support
