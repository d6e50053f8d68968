// One frame as JPEG, for the cine and for DICOM.

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "scene/scene.h"
#include "video/cine_writer.h"
#include "video/dicom_writer.h"

namespace echocine {
namespace {

// Law: a JPEG frame depends on its pixels alone. With subsampled chroma, the library reads one more
// row and column of a picture of odd size.
TEST(JpegFrame, AnOddSizeDoesNotDependOnMemoryBehindIt) {
  const OutputSettings dicom;
  for (const auto& [width, height] : {std::pair(64, 48), {65, 48}, {64, 49}, {65, 49}, {1, 1}}) {
    const auto behind = [width = width, height = height](std::uint8_t other) {
      GreyImage image{width, height, {}};
      const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
      image.pixels.assign(size + 4096, other);
      image.pixels.resize(size);
      for (std::size_t i = 0; i < size; ++i)
        image.pixels[i] = static_cast<std::uint8_t>(60 + 80 * i / size);
      return image;
    };
    const GreyImage dark = behind(0), bright = behind(255);
    EXPECT_EQ(encodeCineFrame(dark, CineCodec::mjpg, 95),
              encodeCineFrame(bright, CineCodec::mjpg, 95))
        << width << " x " << height;
    EXPECT_EQ(encodeDicomFrame(dark, dicom), encodeDicomFrame(bright, dicom))
        << width << " x " << height;
  }
}

}  // namespace
}  // namespace echocine
