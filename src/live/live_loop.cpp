#include "live/live_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/stop.h"
#include "export/export_loops.h"
#include "export/tint.h"

namespace echocine::live {

namespace {

GreyImage cropped(const GreyImage& image, int width, int height) {
  if (image.width == width && image.height == height) return image;
  GreyImage made{width, height, {}};
  made.pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(y) * image.width;
    made.pixels.insert(made.pixels.end(), row, row + width);
  }
  return made;
}

}  // namespace

std::vector<std::byte> encodeLoop(AnimationFormat format, int frames, double rate_hz,
                                  const std::function<GreyImage(int)>& frame) {
  if (frames > kMostLoopFrames)
    throw SceneError(fmt::format("the loop has {} frames, accepted for a file of the page: {}",
                                 frames, kMostLoopFrames));
  const double most_hz = format == AnimationFormat::gif ? kMostGifRate_hz : kMostScreenRate_hz;
  const double duration_s = frames / rate_hz;
  const int shown =
      std::max(1, static_cast<int>(std::lround(duration_s * std::min(rate_hz, most_hz))));
  std::optional<AnimationEncoder> encoder;
  int width = 0, height = 0;
  for (int i = 0; i < shown; ++i) {
    checkpoint();
    const GreyImage image =
        frame(shown == frames ? i : static_cast<int>((i + 0.5) / shown * frames));
    if (!encoder) {
      width = std::max(2, image.width / 2 * 2);
      height = std::max(2, image.height / 2 * 2);
      encoder.emplace(
          AnimationSettings{format, width, height, shown / duration_s, coloursOf(Tint::none)});
    }
    encoder->add(cropped(image, width, height));
  }
  return encoder->finish();
}

}  // namespace echocine::live
