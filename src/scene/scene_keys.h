#pragma once
// The keys of a scene file, in one table. The reader, the JSON and hash of a scene, the range
// checks, the list in this room's README and Python's keys derive from it.

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scene/key_field.h"
#include "scene/number_range.h"

namespace echocine {

// A unit of scene files. Precondition of the table: to_si is increasing.
struct KeyUnit {
  const char* symbol;
  double (*to_si)(double);
  double (*from_si)(double);
};

// Must a scene give the key?
enum class KeyNeed {
  none,         // no; the default is the member's initial value or `fallback`
  always,       // yes
  unless_view,  // yes, unless probe.view is given; then `fallback` applies, or the view sets it
  found         // no; its value then follows from other keys or from the meshes
};

// Condition under which a key has an effect. A scene that gives it otherwise is rejected.
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
  std::optional<double> fallback{};  // in the file's unit, if the member has no initial value

  std::string fullName() const;               // "probe.depth_mm"
  bool applies(const KeyOwner& owner) const;  // does it have an effect there?
  std::string accepted() const;               // "a number from 1 to 2"
};

// All keys, by table, in the order of the reference scene.
std::span<const SceneKey> sceneKeys();

// nullptr if unknown.
const SceneKey* findSceneKey(std::string_view table, std::string_view name);
// Precondition: the key exists.
const SceneKey& sceneKey(std::string_view table, std::string_view name);

// Throws SceneError that names the first key out of range. The reader checks what it reads; scenes
// built in code are checked before they are traced.
void refuseOutOfRange(const Scene& scene);

}  // namespace echocine
