#include <fmt/format.h>

#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "scene/scene_keys.h"

namespace echocine {

std::string SceneKey::fullName() const {
  return *table == '\0' ? std::string(name) : fmt::format("{}.{}", table, name);
}

bool SceneKey::applies(const KeyOwner& owner) const {
  return use.applies == nullptr || use.applies(owner);
}

std::string SceneKey::accepted() const {
  switch (field.kind) {
    case KeyKind::number:
      return range.text();
    case KeyKind::whole:
      return fmt::format("a whole number from {:.0f} to {:.0f}", range.lo, range.hi);
    case KeyKind::flag:
      return "true | false";
    case KeyKind::word:
      return fmt::format("\"{}\"", fmt::join(field.words(), "\" | \""));
    case KeyKind::other:
      break;
  }
  if (field.words != nullptr) return fmt::format("\"{}\"", fmt::join(field.words(), "\" | \""));
  return std::isfinite(range.lo) ? range.text() : std::string();
}

const SceneKey* findSceneKey(std::string_view table, std::string_view name) {
  for (const SceneKey& key : sceneKeys())
    if (table == key.table && name == key.name) return &key;
  return nullptr;
}

const SceneKey& sceneKey(std::string_view table, std::string_view name) {
  const SceneKey* const key = findSceneKey(table, name);
  CHECK_EQ(key == nullptr, false);
  return *key;
}

namespace {

// The ends go through the same conversion as what the reader accepts, so that both agree to the
// last bit.
void refuse(const SceneKey& key, const KeyOwner& owner, const std::string& name) {
  if (key.field.get == nullptr || !key.applies(owner)) return;
  const KeyValue value = key.field.get(owner);
  NumberRange si = key.range;
  si.lo = key.unit.to_si(si.lo);
  si.hi = key.unit.to_si(si.hi);
  if (const auto* const whole = std::get_if<std::int64_t>(&value)) {
    if (!si.contains(static_cast<double>(*whole)))
      throw SceneError(fmt::format("{}: is {}, accepted: {}", name, *whole, key.accepted()));
  } else if (const auto* const number = std::get_if<double>(&value)) {
    if (!si.contains(*number))
      throw SceneError(
          fmt::format("{}: is {}, accepted: {}", name, key.unit.from_si(*number), key.accepted()));
  }
}

}  // namespace

void refuseOutOfRange(const Scene& scene) {
  // Fields give access for the reader too; nothing is changed here.
  Scene& fields = const_cast<Scene&>(scene);
  for (const SceneKey& key : sceneKeys()) {
    const std::string_view table = key.table;
    if (table == "structure")
      for (Structure& s : fields.structures)
        refuse(key, {&fields, &s}, fmt::format("structure.{}: {}", s.name, key.name));
    else if (!table.starts_with("media"))
      refuse(key, {&fields}, key.fullName());
  }
}

}  // namespace echocine
