#pragma once
// The stages of a frame to run, and their options.

#include <functional>
#include <optional>

#include "core/beam_plane.h"

namespace echocine {

struct Making {
  bool traced = false;   // the workspace already has the frame's intensities: later stages only
  bool still = false;    // all lines at the frame's instant, even if they roll
  bool counted = true;   // counts as work of the loop
  bool persists = true;  // mixes in earlier frames, if the scene has persistence
  // Only these lines, all at the frame's instant; the content of the others is undefined.
  std::optional<LineRange> lines{};
  bool picture = false;      // runs scan conversion too
  bool keeps_field = false;  // leaves the field of echoes with speckle in polar.field
  std::optional<double>
      white{};  // of the log compression; without it the frame ends with intensities
  // Receives the intensities of the lines before the signal chain; for rolling lines, whose groups
  // pass the chain separately, after it.
  std::function<void(Intensities&)> received{};
};

}  // namespace echocine
