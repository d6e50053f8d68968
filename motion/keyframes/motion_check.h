#pragma once
// Defects of interpolation between keyframes: triangles that fold over or vanish, surfaces that
// collapse or become inverted.
//
// Faces and vertices of a structure are the same in every keyframe, with lids welded in, so
// interpolation cannot open a closed surface. It can only give it a shape that encloses nothing,
// which its volume shows. A single triangle in space has no correct side. It is inverted
//  - if it is folded onto a neighbour (over 150 degrees between their normals) and the angle is
//  less
//    than 90 degrees in an adjacent keyframe: rotations, of the whole or of a swinging leaflet,
//    keep that angle;
//  - if it looks away from its direction in both adjacent keyframes, which a surface that rotates
//  by
//    less than half a turn does not.
// Frames at a keyframe are input and are not checked. A membrane has no correct side, and leaflets
// crease when they close: for membranes only vanishing triangles are reported.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "motion/keyframes/control_motion.h"

namespace echocine {

struct FramePhase {
  int frame = 0;
  double phase = 0;
};

// mirrored: inverted on the way to a keyframe in which it is folded.
enum class TriangleBreak { mirrored, turned, vanished };

// Position in the loop.
struct BreakPlace {
  int frame = 0;
  std::size_t left = 0, right = 0;  // the adjacent keyframes
};

struct SurfaceBreaks {
  struct First : BreakPlace {
    std::uint32_t triangle = 0;
    TriangleBreak kind = TriangleBreak::turned;
  };
  struct Size : BreakPlace {
    double share = 1;      // relative to the smaller of both keyframes
    double volume_m3 = 0;  // 0 for a membrane
  };
  struct Overshoot : BreakPlace {
    double phase = 0;
    double beyond_m3 = 0;  // above the larger (positive) or below the smaller volume of the two
  };
  std::optional<First> first;          // the lowest triangle of the earliest frame
  std::size_t triangles = 0;           // that break in any frame
  std::optional<Size> collapsed;       // the smallest of the frames, if below the limit
  std::optional<Size> inside_out;      // the earliest frame without positive volume
  std::optional<Overshoot> overshoot;  // the largest of the frames; closed surfaces only
};

// A triangle has vanished below this fraction of its smaller keyframe's area. Our choice.
inline constexpr double kVanishedShare = 0.01;
// A surface has collapsed below this fraction of its smaller keyframe's volume (a membrane: area).
// Linear interpolation of a quarter turn between keyframes leaves one half, of a third of a turn
// this. Our choice.
inline constexpr double kCollapsedShare = 0.25;

// Checks the control mesh, because subdivision averages it and adds no folds. Parallel over the
// gaps between keyframes; a frame takes one interpolation and one pass over triangles and edges.
// The result does not depend on the threads.
SurfaceBreaks findBreaks(const ControlMotion& motion, std::span<const FramePhase> frames);

// Its `inside_out` only, in a fraction of the time.
std::optional<SurfaceBreaks::Size> findInsideOut(const ControlMotion& motion,
                                                 std::span<const FramePhase> frames);

}  // namespace echocine
