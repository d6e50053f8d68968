#pragma once
// Channels of an intensity EXR.

#include <array>
#include <cstddef>

namespace echocine {

enum class Channel { y, unattenuated, attenuation, reflection, backscatter, medium, display };

inline constexpr std::array kAllChannels{
    Channel::y,           Channel::unattenuated, Channel::attenuation, Channel::reflection,
    Channel::backscatter, Channel::medium,       Channel::display};

// The channel's name in scene files and EXR headers: "unattenuated.Y".
constexpr const char* channelName(Channel channel) {
  constexpr std::array kNames{
      "Y",         "unattenuated.Y", "attenuation.A", "reflection.Y", "backscatter.Y",
      "medium.id", "display.Y"};
  return kNames[static_cast<std::size_t>(channel)];
}

}  // namespace echocine
