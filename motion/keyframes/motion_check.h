#pragma once
// What interpolation breaks between keyframes: triangles that fold over or vanish, surfaces that
// collapse or turn inside out.
//
// Faces and vertices of a structure are joined once and are the same in every keyframe, lids welded
// in, so no interpolation can open a closed surface; it can only give it a shape that encloses
// nothing, which its volume tells. A single triangle in space has no right side either. It is
// turned over
//  - when it lies folded onto a neighbour (over 150 degrees between their normals) where they stand
//    at less than 90 degrees in a keyframe beside the frame: rotations, of the whole or of a
//    leaflet that swings, keep that angle;
//  - when it looks away from where it looks in both keyframes beside the frame, which no surface
//    that rotates by less than half a turn from one to the other does.
// Frames at a keyframe are what was read and are not judged. A membrane has no side that could be
// wrong, and leaflets do crease where they close: of membranes only what vanishes is told.

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

// mirrored: turned over on the way to a keyframe in which it lies folded.
enum class TriangleBreak { mirrored, turned, vanished };

// Where in the loop.
struct BreakPlace {
  int frame = 0;
  std::size_t left = 0, right = 0;  // the keyframes beside it
};

struct SurfaceBreaks {
  struct First : BreakPlace {
    std::uint32_t triangle = 0;
    TriangleBreak kind = TriangleBreak::turned;
  };
  struct Size : BreakPlace {
    double share = 1;      // of what the smaller of both keyframes has
    double volume_m3 = 0;  // 0 for a membrane
  };
  struct Overshoot : BreakPlace {
    double phase = 0;
    double beyond_m3 = 0;  // over the larger (positive) or below the smaller volume of the two
  };
  std::optional<First> first;      // the lowest triangle of the earliest frame
  std::size_t triangles = 0;       // that break in any of the frames
  std::optional<Size> collapsed;   // the smallest of the frames, when it is hardly there any more
  std::optional<Size> inside_out;  // the earliest frame whose volume is not over 0
  std::optional<Overshoot> overshoot;  // the furthest of the frames; of closed surfaces alone
};

// A triangle has vanished below this share of its smaller keyframe's area. Our choice.
inline constexpr double kVanishedShare = 0.01;
// A surface has collapsed below this share of its smaller keyframe's volume (a membrane: area): a
// quarter turn from one keyframe to the next leaves half under linear blending, a third of a turn
// this. Our choice.
inline constexpr double kCollapsedShare = 0.25;

// Looks at the control mesh, since subdivision averages it and adds no fold of its own. In parallel
// over the gaps between keyframes; a frame takes one blend and one pass over triangles and edges.
// The result does not depend on the threads.
SurfaceBreaks findBreaks(const ControlMotion& motion, std::span<const FramePhase> frames);

}  // namespace echocine
