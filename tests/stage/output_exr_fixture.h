#pragma once
// What the tests of the EXR stack share.

#include <cmath>
#include <limits>

#include "output/exr_stack.h"
#include "output_fixture.h"

namespace echocine::test {

inline const std::vector<Channel> kEveryChannel{
    Channel::y,           Channel::unattenuated, Channel::attenuation, Channel::reflection,
    Channel::backscatter, Channel::medium,       Channel::display};

// A stack of one small scene with every channel.
class ExrStackTest : public ::testing::Test {
 protected:
  ExrStackTest() {
    scene.output.channels = kEveryChannel;
    scene.acquisition.frame_rate_hz = 29.97;
    fill();
  }

  // Values unlike in every place, over the whole range of floats, zeros of both signs among them.
  void fill() {
    values.clear();
    ids.clear();
    const int count = scene.probe.lines * scene.probe.samples;
    for (int i = 0; i < count; ++i) {
      values.push_back(std::ldexp(1.0f + static_cast<float>(i) / 8192.0f, i % 250 - 125));
      ids.push_back(4000000000u + static_cast<std::uint32_t>(i));
    }
    values[1] = 0.0f;
    values[2] = -0.0f;
    values[3] = std::numeric_limits<float>::denorm_min();
  }

  std::vector<ChannelPlane> planes() const {
    std::vector<ChannelPlane> all;
    for (const Channel channel : scene.output.channels) {
      if (channel == Channel::medium)
        all.push_back({channel, {}, ids});
      else
        all.push_back({channel, values, {}});
    }
    return all;
  }

  ExrStack stack() const { return {folder.path(), scene, hash, 0.125}; }
  std::filesystem::path file() const { return folder / "frame_0007.exr"; }

  TempFolder folder;
  Scene scene = smallScene();
  std::vector<float> values;
  std::vector<std::uint32_t> ids;
  const std::string hash = std::string(64, 'a');
  const FrameRecord record{7, 0.14, 0.1516};
};

}  // namespace echocine::test
