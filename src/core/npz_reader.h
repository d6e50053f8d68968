#pragma once
// Arrays of NumPy's .npz files: written by numpy.savez, numpy.savez_compressed or this program.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/zip_reader.h"

namespace echocine {

// The header of an array.
struct NpyHeader {
  char kind = 0;               // 'f' floats, 'i' and 'u' integers
  std::size_t item_bytes = 0;  // 4 or 8 for floats; 1, 2, 4 or 8 for integers
  bool big_endian = false;
  bool fortran_order = false;
  std::vector<std::size_t> shape;
  std::size_t data_at = 0;  // bytes before the values
};

// The header at the start of a .npy file, format 1 to 3. Throws SceneError, without a name, if it
// is damaged or the values are neither integers nor floats of 32 or 64 bits.
NpyHeader npyHeader(std::span<const std::byte> file);

// "(24, 642, 3)"
std::string shapeText(std::span<const std::size_t> shape);

// Arrays are read when they are requested. Memory is bounded by the size of the file: a shape that
// differs from the size of its data is rejected before memory is taken. All functions throw
// SceneError that starts with the file's name.
class NpzReader {
 public:
  explicit NpzReader(std::filesystem::path file);

  // Names of the arrays, in the file's order.
  std::vector<std::string> names() const;
  bool has(std::string_view array) const;

  // Reads only the array's header.
  NpyHeader header(std::string_view array) const;

  // All values in C order. Big endian and Fortran order are converted. `shape` becomes the array's.
  std::vector<double> numbers(std::string_view array, std::vector<std::size_t>& shape) const;
  // The same for integers; floats are rejected.
  std::vector<std::int64_t> integers(std::string_view array, std::vector<std::size_t>& shape) const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  const ZipEntry& entry(std::string_view array) const;
  std::vector<std::byte> content(std::string_view array, NpyHeader& header) const;

  std::filesystem::path file_;
  std::unique_ptr<const ZipReader> zip_;
};

}  // namespace echocine
