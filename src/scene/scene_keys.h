#pragma once
// The keys of a scene file, in one table. The reader, the JSON and hash of a scene, the checks of
// ranges, the list in this room's README and Python's keys derive from it.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/key_field.h"
#include "scene/number_range.h"

namespace echocine {

// A unit of scene files. Precondition of the table: to_si rises.
struct KeyUnit {
  const char* symbol;
  double (*to_si)(double);
  double (*from_si)(double);
};

// Must a scene give the key?
enum class KeyNeed {
  none,         // its member's initial value, or `fallback`, stands in
  always,       // yes
  unless_view,  // yes, unless probe.view is given: then `fallback` stands in, or it is found
  found         // no; left out, its value follows from other keys or from the meshes
};

// When a key has an effect; elsewhere a scene that gives it is refused.
struct KeyUse {
  bool (*applies)(const KeyOwner&) = nullptr;  // nullptr: always
  const char* with = nullptr;                  // in words of the scene: tgc = "table"
};

struct SceneKey {
  const char* table;  // "probe"; "" at the top; "structure" and "media" for each entry of these
  const char* name;   // as in the file, with its unit: "depth_mm"
  KeyUnit unit;
  NumberRange range;  // in that unit, of a number or of each number of a list
  const char* meaning;
  KeyField field;
  KeyNeed need = KeyNeed::none;
  KeyUse use{};
  std::optional<double> fallback{};  // in the file's unit, where the member has no initial value

  std::string fullName() const;                                // "probe.depth_mm"
  bool applies(const KeyOwner& owner) const;                   // has an effect there
  std::string accepted() const;                                // "a number from 1 to 2"
  std::optional<double> defaultNumber(const KeyOwner&) const;  // in the file's unit
};

// Table by table, in the order of the reference scene.
std::span<const SceneKey> sceneKeys();

// nullptr where there is none.
const SceneKey* findSceneKey(std::string_view table, std::string_view name);
// Precondition: there is one.
const SceneKey& sceneKey(std::string_view table, std::string_view name);

// Throws SceneError that names the first key whose number lies outside its range. The reader has
// checked what it read; scenes built in code are checked before they are traced.
void refuseOutOfRange(const Scene& scene);

}  // namespace echocine
