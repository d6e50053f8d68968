#pragma once
// Reads the keys of a table of a scene by their rows in the table of keys.

#include <string_view>

#include "scene/scene_keys.h"
#include "scene/toml_table.h"

namespace echocine {

// All keys of [table] that are not read by hand, in the order of their rows. Those that the file
// leaves out keep the value of their member, which is their default then. Throws SceneError.
void readKeys(TomlTable& file, std::string_view table, const KeyOwner& owner);

// One of them.
void readKey(TomlTable& file, const SceneKey& key, const KeyOwner& owner);

// In SI, of a key without a member; it must be given.
double readNumber(TomlTable& file, const SceneKey& key);

}  // namespace echocine
