#include "promises.h"
#include "targets.h"
#include "video/read_video.h"

namespace echocine::fuzz {

namespace {

void promiseWhole(const Video& video) {
  const std::size_t pixels =
      static_cast<std::size_t>(video.width) * static_cast<std::size_t>(video.height);
  promise(pixels > 0 && video.frames.size() > 1, "a loop of nothing");
  for (const PixelPlane& frame : video.frames)
    promise(frame.size() == pixels, "a frame of another size");
  promise(video.coloured.size() == pixels, "a mask of another size");
  for (const int repeat : video.repeats)
    promise(repeat > 0 && repeat < video.frameCount(), "a repeat of no frame");
}

}  // namespace

void video(std::string_view bytes) {
  accepts([&] { promiseWhole(readVideoBytes("loop", std::as_bytes(std::span(bytes)))); });
}

}  // namespace echocine::fuzz
