#pragma once
// Which stages of a frame are carried out, and how.

#include <functional>
#include <optional>

#include "core/beam_plane.h"

namespace echocine {

struct Making {
  bool traced = false;   // the workspace's intensities are the frame's already: the later stages
  bool still = false;    // all lines at the frame's instant, even where they roll
  bool counted = true;   // as work of the loop
  bool persists = true;  // greys of earlier frames are mixed in, where the scene asks for it
  bool picture = false;  // scan conversion too
  std::optional<double> white{};  // of the log compression; without it intensities are the last
  // Sees the intensities that the lines receive, before the signal chain; those of rolling lines,
  // whose groups go through it one by one, after it.
  std::function<void(Intensities&)> received{};
};

}  // namespace echocine
