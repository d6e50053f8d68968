#pragma once
// Arrays for NumPy: .npy in memory, and .npz, a zip that stores them uncompressed. C order, little
// endian, the same bytes for the same values.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace echocine {

// A whole .npy file (format 1.0). Precondition: as many values as the shape says.
std::vector<std::byte> npyBytes(std::span<const float> values, std::vector<std::size_t> shape);
std::vector<std::byte> npyBytes(std::span<const std::uint8_t> values,
                                std::vector<std::size_t> shape);
std::vector<std::byte> npyBytes(std::span<const std::int32_t> values,
                                std::vector<std::size_t> shape);

struct NamedArray {
  std::string name;  // without .npy
  std::vector<std::byte> npy;
};

// A whole .npz file. Throws JobError from 4 GiB on, which the plain format cannot hold.
std::vector<std::byte> npzBytes(std::span<const NamedArray> arrays);

}  // namespace echocine
