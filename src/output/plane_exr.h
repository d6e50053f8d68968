#pragma once
// An OpenEXR file of named float planes, apart from the intensity stack.

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace echocine {

struct PlaneExr {
  int width = 0, height = 0;
  // Channels of 32-bit floats by name; rows from the top.
  std::vector<std::pair<std::string, std::span<const float>>> channels;
  std::vector<std::pair<std::string, double>> numbers;  // attributes of the header
  std::vector<std::pair<std::string, std::string>> texts;
};

// The bytes of the file, with ZIP compression and the digest of exr_digest.h. Precondition: each
// channel has width * height values. Throws JobError if the library cannot encode it.
std::vector<std::byte> encodePlaneExr(const PlaneExr& exr);

}  // namespace echocine
