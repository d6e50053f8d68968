#pragma once
// The run whose frames the EXR target resumes and its corpus holds.

#include <string>
#include <vector>

#include "output/frame_record.h"
#include "scene/scene.h"

namespace echocine::fuzz {

inline const std::vector<std::vector<Channel>> kResumeChannels{
    {Channel::y}, {Channel::y, Channel::attenuation, Channel::medium}};
inline const std::string kResumeHash(64, 'a');
inline constexpr double kResumeReference = 0.125;
inline const FrameRecord kResumeFrame{7, 0.14, 0.17};

inline Scene resumeScene(const std::vector<Channel>& channels) {
  Scene scene;
  scene.probe.lines = 3;
  scene.probe.samples = 5;
  scene.output.channels = channels;
  return scene;
}

}  // namespace echocine::fuzz
