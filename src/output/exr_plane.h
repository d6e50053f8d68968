#pragma once
// One channel of an intensity EXR, read back.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/channel.h"

namespace echocine {

struct ExrPlaneWanted {
  Channel channel = Channel::display;  // not isLabel(): floats
  std::string scene_sha256;
  int frame = 0, lines = 0, samples = 0;
};

// The values before any half-float scaling, line-major. None if the file is absent, damaged,
// without the channel, or of another scene, frame or size.
std::optional<std::vector<float>> readExrPlane(const std::filesystem::path& path,
                                               const ExrPlaneWanted& wanted);

// The same for whole numbers. Precondition: isLabel(wanted.channel).
std::optional<std::vector<std::uint32_t>> readExrIds(const std::filesystem::path& path,
                                                     const ExrPlaneWanted& wanted);

// Like readExrPlane(), from bytes just written. Preconditions: the file is from ExrStack::encode();
// it has the channel, which is not Channel::medium.
std::vector<float> readBack(std::span<const std::byte> file, Channel channel);

}  // namespace echocine
