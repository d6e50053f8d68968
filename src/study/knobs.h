#pragma once
// The knobs that trade accuracy for time, each with its values from the roughest to the most
// accurate, and the presets: one definition for `render --preset`, the study and the tolerance.

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
  std::string label;  // as a scene file has it
  std::function<void(Scene&)> apply;
};

// A knob of one scene. Values run from rough to accurate where one can say so; the reference's is
// among them.
struct Knob {
  std::string name;  // of `--knobs`
  std::string key;   // of the scene file
  std::string meaning;
  std::vector<KnobValue> values;
  std::array<std::size_t, kPresets> of_preset{};  // index into values
  // Values from rough to the reference's that save time, for who looks for the cheapest.
  std::vector<std::size_t> ladder{};

  std::size_t reference() const { return of_preset[kPresets - 1]; }
};

struct KnobLeftOut {
  std::string knob, reason;
};

struct KnobTable {
  std::vector<Knob> knobs;
  std::vector<KnobLeftOut> left_out;  // what cannot apply to the scene, and why
};

// One value of each knob: indices in the order of KnobTable::knobs.
using Setting = std::vector<std::size_t>;

// The knobs of a scene. Lines are counted by the beam (1 to 16 to its two-way width at the focus),
// samples by the pulse (1 to 16 to half its length), which are what the picture can resolve.
// Values and presets follow from the scene file and its meshes' sizes alone, never from a clock.
// Reads the meshes once or twice. Throws SceneError as MeshMotion does.
KnobTable knobsOf(const Scene& scene);

// All names that --knobs accepts.
std::vector<std::string> knobNames();

Setting presetSetting(const KnobTable& table, Preset preset);

// The scene with the setting's values.
Scene sceneWith(const Scene& scene, const KnobTable& table, const Setting& setting);

// "probe.lines = 224, probe.samples = 544, ...": as a scene file has it.
std::string settingText(const KnobTable& table, const Setting& setting);

}  // namespace echocine
