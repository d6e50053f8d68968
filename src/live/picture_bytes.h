#pragma once
#include <string>

#include "live/live_renderer.h"

namespace echocine::live {

// A picture for the page: length of a JSON text (4 bytes, little endian), the text, then the grey
// levels, rows from the top.
std::string pictureBytes(const LivePicture& picture, const Scene& scene, Effort effort);

}  // namespace echocine::live
