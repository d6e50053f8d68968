// PointOdyssey: SPLIT/ID/rgbs/rgb_00000.jpg, masks/mask_00000.png with the numbers of structures,
// and annotations of material points.

#include <fmt/format.h>

#include "dataset/layout.h"
#include "output/npy.h"
#include "video/cine_writer.h"

namespace echocine::dataset {

namespace {

// Pixels with the centre of (0, 0) at (0, 0). Older releases read trajs_2d and visibilities, later
// ones trajs_2d, visibs and valids, under another file name; both find what they look for.
std::vector<std::byte> annotations(const LoopSample& loop) {
  const std::size_t frames = loop.frames.size(), points = loop.tracked.size();
  std::vector<float> px, mm;
  std::vector<std::uint8_t> visible;
  for (const LoopFrame& frame : loop.frames)
    for (const Vec3f p : frame.tracks_m) {
      const PixelPoint at = pixelOf(loop.geometry, toDouble(p));
      px.insert(px.end(), {static_cast<float>(at.x - 0.5), static_cast<float>(at.y - 0.5)});
      mm.insert(mm.end(), {1e3f * p.x, 1e3f * p.y, 1e3f * p.z});
      visible.push_back(isShown(loop, p));
    }
  const std::vector<std::uint8_t> valid(frames * points, 1);
  const NamedArray arrays[] = {{"trajs_2d", npyBytes(px, {frames, points, 2})},
                               {"trajs_3d", npyBytes(mm, {frames, points, 3})},
                               {"visibilities", npyBytes(visible, {frames, points})},
                               {"visibs", npyBytes(visible, {frames, points})},
                               {"valids", npyBytes(valid, {frames, points})}};
  return npzBytes(arrays);
}

void writePointodyssey(const Spec&, const Heart& heart, Sink& sink, Json&) {
  for (const LoopSample& loop : heart.loops) {
    const std::string folder = fmt::format("pointodyssey/{}/{}/", nameOf(heart.split), loop.id);
    for (std::size_t f = 0; f < loop.frames.size(); ++f)
      sink.write(fmt::format("{}rgbs/rgb_{:05}.jpg", folder, f),
                 encodeCineFrame(loop.frames[f].image, CineCodec::mjpg, kJpegQuality));
    for (std::size_t f = 0; f < loop.frames.size(); ++f)
      sink.write(fmt::format("{}masks/mask_{:05}.png", folder, f),
                 encodePng(GreyImage{loop.width(), loop.height(), loop.frames[f].labels}));
    const std::vector<std::byte> npz = annotations(loop);
    sink.write(folder + "annotations.npz", npz);
    sink.write(folder + "anno.npz", npz);
  }
}

}  // namespace

const Layout kPointodyssey{"pointodyssey", writePointodyssey, nullptr};

}  // namespace echocine::dataset
