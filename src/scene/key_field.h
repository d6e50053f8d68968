#pragma once
// Uniform access to the members of a scene's structs that hold the values of keys.

#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "scene/key_log.h"
#include "scene/medium.h"
#include "scene/names.h"
#include "scene/scene.h"

namespace echocine {

// In SI units; words by name. std::monostate for an optional member without a value.
using KeyValue = KeyDefault;

// The object that contains a key's member: the scene; for [[structure]] also the structure; for
// [media.NAME] the unresolved medium.
struct KeyOwner {
  Scene* scene = nullptr;
  Structure* structure = nullptr;
  MediumSpec* medium = nullptr;
};

enum class KeyKind { number, whole, flag, word, other };

struct KeyField {
  KeyKind kind = KeyKind::other;  // other: read by its own code
  const char* member = nullptr;   // its name in the JSON; null: the JSON has another form
  KeyValue (*get)(const KeyOwner&) = nullptr;
  void (*set)(const KeyOwner&, const KeyValue&) = nullptr;
  std::vector<std::string_view> (*words)() = nullptr;  // of KeyKind::word
};

namespace key_field {

inline Scene& partOf(const KeyOwner& o, Scene*) {
  return *o.scene;
}
inline Probe& partOf(const KeyOwner& o, Probe*) {
  return o.scene->probe;
}
inline ViewPlacement& partOf(const KeyOwner& o, ViewPlacement*) {
  return *o.scene->view;
}
inline Acquisition& partOf(const KeyOwner& o, Acquisition*) {
  return o.scene->acquisition;
}
inline MotionSettings& partOf(const KeyOwner& o, MotionSettings*) {
  return o.scene->motion;
}
inline EffectSwitches& partOf(const KeyOwner& o, EffectSwitches*) {
  return o.scene->effects;
}
inline SpeckleSettings& partOf(const KeyOwner& o, SpeckleSettings*) {
  return o.scene->speckle;
}
inline ArtefactSettings& partOf(const KeyOwner& o, ArtefactSettings*) {
  return o.scene->artefacts;
}
inline SignalSettings& partOf(const KeyOwner& o, SignalSettings*) {
  return o.scene->signal;
}
inline AccuracySettings& partOf(const KeyOwner& o, AccuracySettings*) {
  return o.scene->accuracy;
}
inline OutputSettings& partOf(const KeyOwner& o, OutputSettings*) {
  return o.scene->output;
}
inline TruthSettings& partOf(const KeyOwner& o, TruthSettings*) {
  return o.scene->truth;
}
inline TrabeculaeSettings& partOf(const KeyOwner& o, TrabeculaeSettings*) {
  return o.scene->trabeculae;
}
inline LeafletSettings& partOf(const KeyOwner& o, LeafletSettings*) {
  return o.scene->leaflets;
}
inline Structure& partOf(const KeyOwner& o, Structure*) {
  return *o.structure;
}
inline MediumSpec& partOf(const KeyOwner& o, MediumSpec*) {
  return *o.medium;
}

template <typename M>
struct MemberOf;
template <typename C, typename T>
struct MemberOf<T C::*> {
  using Class = C;
  using Type = T;
};

template <typename T>
KeyValue valueFrom(const T& member) {
  if constexpr (std::is_enum_v<T>)
    return std::string(nameOf(member));
  else if constexpr (std::is_same_v<T, std::optional<double>>)
    return member ? KeyValue(*member) : KeyValue();
  else if constexpr (std::is_same_v<T, int>)
    return std::int64_t{member};
  else
    return member;
}

template <typename T>
void put(T& member, const KeyValue& value) {
  if constexpr (std::is_enum_v<T>)
    member = valueOf<T>(std::get<std::string>(value)).value();
  else if constexpr (std::is_same_v<T, std::optional<double>>)
    member = std::get<double>(value);
  else if constexpr (std::is_same_v<T, int>)
    member = static_cast<int>(std::get<std::int64_t>(value));
  else
    member = std::get<T>(value);
}

template <typename T>
std::vector<std::string_view> wordsOf() {
  std::vector<std::string_view> words;
  if constexpr (std::is_enum_v<T>)
    for (const Named<T>& entry : NamesOf<T>::kAll) words.emplace_back(entry.name);
  return words;
}

template <typename T>
constexpr KeyKind kindOf() {
  if (std::is_enum_v<T>) return KeyKind::word;
  if (std::is_same_v<T, bool>) return KeyKind::flag;
  return std::is_same_v<T, int> ? KeyKind::whole : KeyKind::number;
}

template <auto kMember>
constexpr KeyField of(const char* name) {
  using C = typename MemberOf<decltype(kMember)>::Class;
  using T = typename MemberOf<decltype(kMember)>::Type;
  return {
      kindOf<T>(), name,
      [](const KeyOwner& o) { return valueFrom<T>(partOf(o, static_cast<C*>(nullptr)).*kMember); },
      [](const KeyOwner& o, const KeyValue& v) {
        put<T>(partOf(o, static_cast<C*>(nullptr)).*kMember, v);
      },
      &wordsOf<T>};
}

}  // namespace key_field

}  // namespace echocine
