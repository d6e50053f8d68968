// MyoTracker: ID/ID.h5 with the pictures and the material points of one loop.

#include <fmt/format.h>

#include "dataset/layout.h"
#include "hdf/hdf5_file.h"

namespace echocine::dataset {

namespace {

// Its loader takes row before column, as shares of the picture's height and width, the centre of
// pixel (0, 0) at (0, 0).
std::vector<float> sharesOf(const LoopSample& loop) {
  std::vector<float> shares;
  for (const LoopFrame& frame : loop.frames)
    for (const Vec3f p : frame.tracks_m) {
      const PixelPoint at = pixelOf(loop.geometry, toDouble(p));
      shares.insert(shares.end(), {static_cast<float>((at.y - 0.5) / loop.height()),
                                   static_cast<float>((at.x - 0.5) / loop.width())});
    }
  return shares;
}

// A folder for each loop: the loader takes exactly one file from each.
void writeMyotracker(const Spec&, const Heart& heart, Sink& sink, Json&) {
  for (const LoopSample& loop : heart.loops) {
    std::vector<std::uint8_t> pixels;
    for (const LoopFrame& frame : loop.frames)
      pixels.insert(pixels.end(), frame.image.pixels.begin(), frame.image.pixels.end());
    const std::vector<float> shares = sharesOf(loop);
    const std::size_t frames = loop.frames.size();
    const Hdf5Array arrays[] = {
        {"frames",
         {frames, static_cast<std::size_t>(loop.height()), static_cast<std::size_t>(loop.width())},
         std::span<const std::uint8_t>(pixels),
         true},
        {"meshes", {frames, loop.tracked.size(), 2}, std::span<const float>(shares)}};
    sink.write(fmt::format("myotracker/{0}/{1}/{1}.h5", nameOf(heart.split), loop.id),
               hdf5Bytes(arrays));
  }
}

}  // namespace

const Layout kMyotracker{"myotracker", writeMyotracker, nullptr};

}  // namespace echocine::dataset
