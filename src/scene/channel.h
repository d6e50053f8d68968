#pragma once
// Channels of an intensity EXR.

#include <array>
#include <cstddef>

namespace echocine {

enum class Channel {
  y,
  unattenuated,
  attenuation,
  reflection,
  backscatter,
  medium,
  display,
  // Truth at the sample's centre; no ray is traced for it.
  structure,             // 0 in the background, else the structure's position in the scene, from 1
  displacement_lateral,  // of the material since the reference frame, mm
  displacement_axial,
  displacement_elevation,
  velocity_lateral,  // mm/s
  velocity_axial,
  velocity_elevation,
  velocity_beam,  // along the line, positive towards the probe, m/s
};

inline constexpr std::array kAllChannels{
    Channel::y,           Channel::unattenuated, Channel::attenuation, Channel::reflection,
    Channel::backscatter, Channel::medium,       Channel::display};

inline constexpr std::array kTruthChannels{
    Channel::structure,          Channel::displacement_lateral,
    Channel::displacement_axial, Channel::displacement_elevation,
    Channel::velocity_lateral,   Channel::velocity_axial,
    Channel::velocity_elevation, Channel::velocity_beam};

constexpr bool isTruth(Channel channel) {
  return channel >= Channel::structure;
}
// Motion of the material: NaN where no motion is defined.
constexpr bool isMotion(Channel channel) {
  return channel > Channel::structure;
}
constexpr bool isVelocity(Channel channel) {
  return channel >= Channel::velocity_lateral;
}
// Channels of whole numbers.
constexpr bool isLabel(Channel channel) {
  return channel == Channel::medium || channel == Channel::structure;
}

// The channel's name in scene files and EXR headers: "unattenuated.Y".
constexpr const char* channelName(Channel channel) {
  constexpr std::array kNames{"Y",
                              "unattenuated.Y",
                              "attenuation.A",
                              "reflection.Y",
                              "backscatter.Y",
                              "medium.id",
                              "display.Y",
                              "structure.id",
                              "displacement.lateral",
                              "displacement.axial",
                              "displacement.elevation",
                              "velocity.lateral",
                              "velocity.axial",
                              "velocity.elevation",
                              "velocity.beam"};
  return kNames[static_cast<std::size_t>(channel)];
}

}  // namespace echocine
