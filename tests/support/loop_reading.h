#pragma once
// Loops that are written by each format's own library and read back, or refused.

#include <gtest/gtest.h>

#include <string>

#include "compare/compare.h"
#include "core/error.h"
#include "support/echo_video.h"
#include "support/temp_folder.h"

namespace echocine::echo {

using namespace support;

inline Drawing small() {
  Drawing d;
  d.frames = 6;
  return d;
}

inline std::string refusal(const std::filesystem::path& path) {
  try {
    readLoop(path, {}, true);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

inline void expectRefusal(const std::filesystem::path& path, const std::string& part) {
  const std::string said = refusal(path);
  EXPECT_NE(said.find(part), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

class Reading : public ::testing::Test {
 protected:
  const Drawing drawing = small();
  const std::vector<PixelPlane> frames = drawnLoop(drawing);
  TempFolder folder;
};

}  // namespace echocine::echo
