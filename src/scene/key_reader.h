#pragma once
// Reads the keys of a scene's table by their rows in the table of keys.

#include <string_view>

#include "scene/scene_keys.h"
#include "scene/toml_table.h"

namespace echocine {

// All keys of [table] except those with their own reading code, in the order of their rows. An
// absent key keeps the initial value of its member. Throws SceneError.
void readKeys(TomlTable& file, std::string_view table, const KeyOwner& owner);

// Reads one key.
void readKey(TomlTable& file, const SceneKey& key, const KeyOwner& owner);

// Reads a required key without a member, in SI units.
double readNumber(TomlTable& file, const SceneKey& key);

}  // namespace echocine
