#pragma once
// The knobs that trade accuracy for time, each with values from rough to accurate, and the presets:
// one definition for `render --preset`, the study and the tolerance.

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace echocine {

enum class Preset { draft, standard, fine, reference };
inline constexpr std::size_t kPresets = 4;
inline constexpr std::array<const char*, kPresets> kPresetNames{"draft", "standard", "fine",
                                                                "reference"};

struct KnobValue {
  std::string label;  // as in a scene file
  std::function<void(Scene&)> apply;
};

// A knob of one scene. Values are ordered from rough to accurate where that is defined, and include
// the reference's.
struct Knob {
  std::string name;  // of `--knobs`
  std::string key;   // of the scene file
  std::string meaning;
  std::vector<KnobValue> values;
  std::array<std::size_t, kPresets> of_preset{};  // index into values
  // Values from rough to the reference's that save time, for the search of the cheapest setting.
  std::vector<std::size_t> ladder{};

  std::size_t reference() const { return of_preset[kPresets - 1]; }
};

struct KnobLeftOut {
  std::string knob, reason;
};

struct KnobTable {
  std::vector<Knob> knobs;
  std::vector<KnobLeftOut> left_out;  // inapplicable to the scene, with reasons
};

// One value of each knob: indices in the order of KnobTable::knobs.
using Setting = std::vector<std::size_t>;

// The knobs of a scene. Lines are counted per beam (1 to 16 per two-way width at the focus),
// samples per pulse (1 to 16 per half length): the resolution of the picture. Values and presets
// follow from the scene file and the sizes of its meshes, never from a clock. Reads the meshes once
// or twice. Throws SceneError like MeshMotion.
KnobTable knobsOf(const Scene& scene);

// All names that --knobs accepts.
std::vector<std::string> knobNames();

Setting presetSetting(const KnobTable& table, Preset preset);

// The scene with the setting's values.
Scene sceneWith(const Scene& scene, const KnobTable& table, const Setting& setting);

// "probe.lines = 224, probe.samples = 544, ...", as in a scene file.
std::string settingText(const KnobTable& table, const Setting& setting);

}  // namespace echocine
