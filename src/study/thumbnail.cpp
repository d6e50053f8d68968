#include "study/thumbnail.h"

#include <algorithm>
#include <cmath>

#include "video/cine_writer.h"

// Thumbnails are looked at, never measured: the errors come from the full pictures.
namespace echocine {

namespace {

constexpr int kWidth_px = 320;
constexpr int kQuality = 80;

// Means of n x n pixels.
GreyImage reduced(const GreyImage& image) {
  const int n = std::min((image.width + kWidth_px - 1) / kWidth_px, image.height);
  GreyImage small{image.width / n, image.height / n, {}};
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      int sum = 0;
      for (int dy = 0; dy < n; ++dy)
        for (int dx = 0; dx < n; ++dx)
          sum += image.pixels[static_cast<std::size_t>((y * n + dy) * image.width + x * n + dx)];
      small.pixels.push_back(static_cast<std::uint8_t>((sum + n * n / 2) / (n * n)));
    }
  return small;
}

}  // namespace

std::vector<std::byte> thumbnail(const GreyImage& image) {
  return encodeCineFrame(reduced(image), CineCodec::mjpg, kQuality);
}

std::vector<std::byte> differenceThumbnail(const FramePicture& setting,
                                           const FramePicture& reference, double dynamic_range_db) {
  GreyImage difference{setting.image.width, setting.image.height, {}};
  for (std::size_t i = 0; i < setting.grey.size(); ++i) {
    const double db = dynamic_range_db * std::abs(static_cast<double>(setting.grey[i]) -
                                                  static_cast<double>(reference.grey[i]));
    difference.pixels.push_back(
        static_cast<std::uint8_t>(std::lround(255 * std::min(db / kWhiteDifference_db, 1.0))));
  }
  return thumbnail(difference);
}

}  // namespace echocine
