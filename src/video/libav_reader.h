#pragma once
// Whatever the libav libraries decode, from memory.

#include <cstddef>
#include <span>

#include "video/video_builder.h"

namespace echocine {

// Adds every frame of the first video stream; sets the builder's format and container rate (as not
// trusted). Frames whose pixels are not square are stretched to square ones, with a note.
// Throws SceneError: no video, unknown codec, damaged, beyond the limits.
void readByLibav(std::span<const std::byte> bytes, VideoBuilder& builder);

}  // namespace echocine
