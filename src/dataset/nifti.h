#pragma once
// NIfTI-1 single files of grey or label pictures, gzipped (https://nifti.nimh.nih.gov/nifti-1).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace echocine::dataset {

struct NiftiShape {
  int width = 0, height = 0;
  int frames = 0;  // 0: a single two-dimensional picture
  double dx_mm = 1, dy_mm = 1, dt_s = 1;
};

// pixels: column fastest, then row from the top, then frame. Throws JobError.
std::vector<std::byte> niftiBytes(const NiftiShape& shape, std::span<const std::uint8_t> pixels);

}  // namespace echocine::dataset
