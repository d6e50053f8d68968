#pragma once
// The shipped heart as the paper draws it: the same scene without speckle and artefacts.

#include <string>

#include "scene/scene_reader.h"
#include "support/paths.h"
#include "support/temp_folder.h"

namespace echocine::support {

inline Scene shippedPaperHeart() {
  const std::filesystem::path file =
      std::filesystem::path(kSourceDir) / "examples/beating_heart/scene.toml";
  std::string text = bytesOf(file);
  const std::string look = "look = \"scanner\"";
  text.replace(text.find(look), look.size(), "look = \"paper\"\ndynamic_range_db = 58");
  return parseScene(text, file);
}

}  // namespace echocine::support
