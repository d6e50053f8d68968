#pragma once
// The media of a scene: the built-in table, then the scene's own [media.NAME].

#include <map>
#include <string>

#include "scene/medium.h"
#include "scene/toml_table.h"

namespace echocine {

class MediaTable {
 public:
  // Starts with the built-in media.
  MediaTable();

  // Adds [media.*] of a file, replacing media of the same name.
  void read(TomlTable& file);

  // The medium named by `key` of `table`. Throws SceneError with the nearest known name.
  const MediumSpec& named(TomlTable& table, std::string_view key, std::string fallback = "") const;

 private:
  MediumSpec readMedium(const std::string& name, TomlTable& table) const;
  std::map<std::string, MediumSpec> specs_;
};

}  // namespace echocine
