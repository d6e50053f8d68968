#include "dataset/nifti.h"

#include <bit>
#include <cstring>

#include "core/check.h"
#include "dataset/compressed.h"

namespace echocine::dataset {

namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kHeader = 348, kData = 352;

template <typename T>
void put(std::vector<std::byte>& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

}  // namespace

// Offsets and codes are the standard's own.
std::vector<std::byte> niftiBytes(const NiftiShape& shape, std::span<const std::uint8_t> pixels) {
  const int frames = shape.frames > 0 ? shape.frames : 1;
  CHECK_EQ(pixels.size(), static_cast<std::size_t>(shape.width) *
                              static_cast<std::size_t>(shape.height) *
                              static_cast<std::size_t>(frames));
  std::vector<std::byte> file(kData + pixels.size());
  put(file, 0, std::int32_t{kHeader});
  put(file, 38, 'r');
  const int dim[8] = {shape.frames > 0 ? 3 : 2, shape.width, shape.height, frames, 1, 1, 1, 1};
  for (std::size_t i = 0; i < 8; ++i) put(file, 40 + 2 * i, static_cast<std::int16_t>(dim[i]));
  put(file, 70, std::int16_t{2});  // unsigned bytes
  put(file, 72, std::int16_t{8});  // bits of each
  const double pixdim[4] = {1, shape.dx_mm, shape.dy_mm, shape.frames > 0 ? shape.dt_s : 1};
  for (std::size_t i = 0; i < 4; ++i) put(file, 76 + 4 * i, static_cast<float>(pixdim[i]));
  put(file, 108, static_cast<float>(kData));
  put(file, 112, 1.0f);             // slope, intercept 0
  put(file, 123, char{10});         // mm and s
  put(file, 252, std::int16_t{1});  // scanner's frame, as quaternion: none
  put(file, 254, std::int16_t{1});  // and as affine
  for (std::size_t i = 0; i < 3; ++i)
    put(file, 280 + 16 * i + 4 * i, static_cast<float>(pixdim[i + 1]));
  std::memcpy(file.data() + 344, "n+1", 4);
  std::memcpy(file.data() + kData, pixels.data(), pixels.size());
  return gzipped(file);
}

}  // namespace echocine::dataset
