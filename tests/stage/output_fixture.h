#pragma once
// What the tests of the output stage share: a small scene, a folder that vanishes, a full disk.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "scene/scene.h"
#include "support/temp_folder.h"
#include "video/cine_writer.h"

namespace echocine::test {

using support::bytesOf;
using support::TempFolder;

// While it lives no file grows past `bytes`: writes fail as they do on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    previous_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &previous_);
    rlimit limit = previous_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &previous_);
    std::signal(SIGXFSZ, previous_handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit previous_{};
  void (*previous_handler_)(int) = SIG_DFL;
};

inline void putBytes(const std::filesystem::path& path, const std::string& bytes) {
  std::filesystem::remove(path);  // some file systems flush a file that is emptied and refilled
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::size_t filesIn(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

// The message of the Error that `act` throws; a failure when it throws nothing.
template <typename Error, typename Act>
std::string messageOf(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

// A phased sector of 90 degrees, 16 cm deep.
inline Scene smallScene() {
  Scene scene;
  Probe& probe = scene.probe;
  probe.pose.origin = {0.01, -0.02, 0.03};
  probe.first_angle_rad = -0.25 * std::numbers::pi;
  probe.last_angle_rad = 0.25 * std::numbers::pi;
  probe.min_depth_m = 0.002;
  probe.max_depth_m = 0.16;
  probe.frequency_hz = 2.5e6;
  probe.lines = 13;
  probe.samples = 70;
  scene.output.width = 320;
  scene.output.height = 240;
  return scene;
}

// A smooth picture that differs from frame to frame.
inline GreyImage picture(int width, int height, int frame) {
  GreyImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.pixels.push_back(static_cast<std::uint8_t>((x / 2 + y / 2 + 20 * frame) % 200));
  return image;
}

}  // namespace echocine::test
