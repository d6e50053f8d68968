#pragma once
// Arrays for NumPy: .npy in memory, and .npz, an uncompressed zip of them. C order, little endian,
// deterministic bytes.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace echocine {

// A complete .npy file (format 1.0). Precondition: the number of values matches the shape.
std::vector<std::byte> npyBytes(std::span<const float> values, std::vector<std::size_t> shape);
std::vector<std::byte> npyBytes(std::span<const double> values, std::vector<std::size_t> shape);
std::vector<std::byte> npyBytes(std::span<const std::uint8_t> values,
                                std::vector<std::size_t> shape);
std::vector<std::byte> npyBytes(std::span<const std::int32_t> values,
                                std::vector<std::size_t> shape);

struct NamedArray {
  std::string name;  // without .npy
  std::vector<std::byte> npy;
};

// A complete .npz file. Throws JobError from 4 GiB on, the limit of the plain format.
std::vector<std::byte> npzBytes(std::span<const NamedArray> arrays);

}  // namespace echocine
