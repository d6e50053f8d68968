#pragma once
// Reads arrays of an HDF5 file that may be damaged or malicious.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace echocine {

struct Hdf5Query {
  std::string name;             // with its groups: "metadata/ecg/samples"
  std::size_t most_values = 1;  // more are refused before they are read; bytes of a text
  bool attribute = false;       // a text attribute of the root group instead
};

// In C order. Unsigned bytes stay bytes, other numbers become floats. One value has an empty shape.
struct Hdf5Values {
  bool found = false;
  std::vector<std::size_t> shape;
  std::variant<std::vector<std::uint8_t>, std::vector<float>, std::string> values;
};

inline constexpr std::size_t kMostHdf5Bytes = std::size_t{2} << 30;  // of a file; our choice

// One answer per query, in their order; absent names have found = false. Only data inside the file
// are read: links to other files and data stored outside are refused. The library runs in a child
// process with limits of CPU time and memory (core/limited_child.h), because it may crash or loop
// on a damaged file. Thread-safe. Throws SceneError of one line, with the file's name; JobError.
std::vector<Hdf5Values> readHdf5(const std::filesystem::path& file,
                                 std::span<const Hdf5Query> queries);

// By the signature at the start of the file.
bool looksLikeHdf5(const std::filesystem::path& file);

}  // namespace echocine
