#pragma once
// Decodes all formats of the libav libraries, from memory.

#include <cstddef>
#include <span>

#include "video/video_builder.h"

namespace echocine {

// Adds every frame of the first video stream; sets the builder's format and container rate (marked
// as not trusted). Frames with non-square pixels are resampled to square ones, with a note. Throws
// SceneError for no video, an unknown codec, damage, or sizes beyond the limits.
void readByLibav(std::span<const std::byte> bytes, VideoBuilder& builder);

}  // namespace echocine
