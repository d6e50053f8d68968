#include "scene/key_reader.h"

namespace echocine {

namespace {

bool isNeeded(const SceneKey& key, const KeyOwner& owner) {
  return key.need == KeyNeed::always ||
         (key.need == KeyNeed::unless_view && !owner.scene->view.has_value());
}

// Nothing where the key must be given.
std::optional<double> defaultOf(const SceneKey& key, const KeyOwner& owner, const KeyValue& value) {
  if (isNeeded(key, owner)) return std::nullopt;
  if (key.fallback) return key.fallback;
  if (const auto* const whole = std::get_if<std::int64_t>(&value))
    return static_cast<double>(*whole);
  return key.unit.from_si(std::get<double>(value));
}

KeyValue valueIn(TomlTable& file, const SceneKey& key, const KeyOwner& owner,
                 const KeyValue& value) {
  switch (key.field.kind) {
    case KeyKind::number:
      return key.unit.to_si(file.number(key.name, defaultOf(key, owner, value), key.range));
    case KeyKind::whole: {
      const std::optional<double> fallback = defaultOf(key, owner, value);
      return std::int64_t{file.integer(
          key.name, fallback ? std::optional(static_cast<int>(*fallback)) : std::nullopt,
          static_cast<int>(key.range.lo), static_cast<int>(key.range.hi))};
    }
    case KeyKind::flag:
      return file.boolean(key.name, std::get<bool>(value));
    case KeyKind::word:
      return file.word(key.name, std::get<std::string>(value), key.field.words());
    case KeyKind::other:
      break;
  }
  return {};
}

}  // namespace

void readKey(TomlTable& file, const SceneKey& key, const KeyOwner& owner) {
  if (key.field.kind == KeyKind::other) return;
  if (!key.applies(owner)) return file.unused(key.name, key.use.with);
  const KeyValue value = key.field.get(owner);
  const bool has_default =
      isNeeded(key, owner) || key.fallback.has_value() ||
      (key.need == KeyNeed::none && !std::holds_alternative<std::monostate>(value));
  if (!file.has(key.name) && !has_default) return;
  if (std::holds_alternative<std::monostate>(value) && file.has(key.name))
    return key.field.set(owner, key.unit.to_si(file.number(key.name, std::nullopt, key.range)));
  key.field.set(owner, valueIn(file, key, owner, value));
}

void readKeys(TomlTable& file, std::string_view table, const KeyOwner& owner) {
  for (const SceneKey& key : sceneKeys())
    if (table == key.table) readKey(file, key, owner);
}

double readNumber(TomlTable& file, const SceneKey& key) {
  return key.unit.to_si(file.number(key.name, std::nullopt, key.range));
}

}  // namespace echocine
