#pragma once
// Reads a zarr store in a folder, version 2 or 3, that may be damaged or malicious.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "zarr/zarr_metadata.h"

namespace echocine {

// In C order.
template <typename T>
struct ZarrValues {
  std::vector<std::size_t> shape;
  std::vector<T> values;
  std::size_t absent_chunks = 0;  // have the fill value
};

// Does the folder hold a store's root metadata?
bool isZarrStore(const std::filesystem::path& folder);

class ZarrInput {
 public:
  // Throws SceneError of one line if the root's metadata cannot be read; so do all others.
  explicit ZarrInput(std::filesystem::path folder);

  // Attributes of the root group.
  const nlohmann::json& attributes() const { return attributes_; }

  bool has(const std::string& array) const;
  // Names are those of files inside the store: refused are "..", absolute ones, and links.
  ZarrLayout layout(const std::string& array) const;

  // Arrays of uint8; and numbers of any supported type. More than `most` values are refused before
  // memory is taken.
  ZarrValues<std::uint8_t> bytes(const std::string& array, std::size_t most) const;
  ZarrValues<double> numbers(const std::string& array, std::size_t most) const;

 private:
  std::filesystem::path inside(const std::string& name) const;
  std::string text(const std::filesystem::path& name) const;
  template <typename T>
  ZarrValues<T> read(const std::string& array, const ZarrLayout& layout) const;

  std::filesystem::path folder_;
  int version_ = 2;
  nlohmann::json attributes_;
};

}  // namespace echocine
