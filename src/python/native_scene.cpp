#include "python/native_scene.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "core/error.h"
#include "core/nearest_word.h"
#include "core/parallel.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/heart_truth.h"
#include "motion/heart/recording.h"
#include "python/bindings.h"
#include "python/job.h"
#include "python/meshes.h"
#include "scene/names.h"
#include "scene/scene_json.h"
#include "scene/scene_keys.h"

#include <nlohmann/json.hpp>

namespace echocine::python {

namespace {

// Without meshes in memory keyframes are files.
NativeScene read(const std::string& text, const std::string& file, const Meshes* meshes) {
  const KeyLog log;
  NativeScene native;
  native.scene = meshes ? parseScene(text, file, meshes->named) : parseScene(text, file);
  native.absent = log.absent();
  return native;
}

py::object toPython(const KeyDefault& value) {
  return std::visit(
      [](const auto& v) -> py::object {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return py::none();
        else
          return py::cast(v);
      },
      value);
}

py::dict absentKeys(const NativeScene& native) {
  py::dict keys;
  for (const auto& [key, value] : native.absent) keys[py::str(key)] = toPython(value);
  if (!native.scene.output.channels_given) {
    py::list channels;
    for (const Channel channel : native.scene.output.channels)
      channels.append(channelName(channel));
    keys["output.channels"] = channels;
  }
  return keys;
}

py::list structures(const NativeScene& native) {
  py::list list;
  for (const Structure& s : native.scene.structures) {
    py::dict entry;
    entry["name"] = s.name;
    entry["medium"] = native.scene.medium(s.medium).name;
    entry["role"] = nameOf(s.role);
    std::vector<double> phases;
    std::vector<std::string> files;
    for (const Keyframe& keyframe : s.keyframes) {
      phases.push_back(keyframe.phase);
      files.push_back(keyframe.files.front().string());
    }
    entry["phases"] = phases;
    entry["files"] = files;
    entry["membrane"] = s.membrane;
    list.append(entry);
  }
  return list;
}

// Depths in m; "json": all of it in SI, as the manifest has it.
py::dict probe(const NativeScene& native) {
  const Probe& p = native.scene.probe;
  py::dict entry;
  entry["kind"] = nameOf(p.kind);
  entry["lines"] = p.lines;
  entry["samples"] = p.samples;
  entry["min_depth_m"] = p.min_depth_m;
  entry["max_depth_m"] = p.max_depth_m;
  entry["json"] = sceneJson(native.scene).at("probe").dump();
  return entry;
}

[[noreturn]] void refuseName(const std::string& argument, const std::string& key,
                             const std::vector<std::string>& accepted) {
  throw SceneError(fmt::format("{}: is \"{}\", accepted: \"{}\"", argument, key,
                               fmt::join(accepted, "\" | \"")));
}

}  // namespace

View viewFrom(const std::string& argument, const std::string& key) {
  if (const auto view = heart::viewOf(key)) return *view;
  std::vector<std::string> names;
  for (const heart::ViewName& name : heart::viewNames()) names.emplace_back(name.key);
  refuseName(argument, key, names);
}

namespace {

Look lookFrom(const std::string& argument, const std::string& key) {
  if (const auto look = valueOf<Look>(key)) return *look;
  std::vector<std::string> names;
  for (const Named<Look>& look : NamesOf<Look>::kAll) names.emplace_back(look.name);
  refuseName(argument, key, names);
}

// Dials by the names that Python has for them: underscores for hyphens.
heart::Parameters parametersFrom(const std::map<std::string, double>& dials,
                                 const std::map<int, std::pair<double, double>>& segments,
                                 bool keep_volumes) {
  std::map<std::string, double> by_key;
  std::vector<std::string> names;
  for (const heart::Dial& dial : heart::dials()) {
    names.emplace_back(dial.key);
    std::replace(names.back().begin(), names.back().end(), '-', '_');
    if (const auto given = dials.find(names.back()); given != dials.end())
      by_key.emplace(dial.key, given->second);
  }
  for (const auto& dial : dials)
    if (std::find(names.begin(), names.end(), dial.first) == names.end()) {
      std::string lower = dial.first;
      for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      const std::string nearest = nearestWord(lower, names);
      throw SceneError(fmt::format("heart: {}: is not a dial, {}", dial.first,
                                   nearest.empty()
                                       ? fmt::format("accepted: {}", fmt::join(names, ", "))
                                       : "nearest: " + nearest));
    }
  if (const std::string fault = heart::contradictionIn(by_key); !fault.empty())
    throw SceneError("heart: " + fault);
  heart::Parameters parameters = heart::parametersFrom(by_key);
  for (const auto& [number, segment] : segments) {
    if (number < 1 || number > heart::kSegments)
      throw SceneError(
          fmt::format("heart: segments: holds {}, accepted: 1 to {}", number, heart::kSegments));
    parameters.segments[static_cast<std::size_t>(number - 1)] = {segment.first, segment.second};
  }
  parameters.volumes_rule = keep_volumes;
  if (const std::string fault = heart::faultOf(parameters); !fault.empty())
    throw SceneError("heart: " + fault);
  return parameters;
}

py::tuple makeHeart(const std::string& view_key, const std::map<std::string, double>& dials,
                    const std::map<int, std::pair<double, double>>& segments, bool keep_volumes,
                    int keyframes, const std::string& look_key, bool even, int threads,
                    const py::object& progress) {
  const heart::View view = viewFrom("heart: view", view_key);
  const Look look = lookFrom("heart: look", look_key);
  const heart::Parameters parameters = parametersFrom(dials, segments, keep_volumes);
  if (keyframes < 4 || keyframes > 100)
    throw SceneError(fmt::format("heart: keyframes: is {}, accepted: 4 to 100", keyframes));
  std::string text;
  Meshes meshes;
  runJob(progress, [&](const Monitor& monitor) {
    withThreads(threads, [&] {
      const heart::ParametricHeart model(parameters);
      const heart::Recording recording = heart::record(
          model, view, keyframes,
          even ? heart::KeyframeSpacing::even : heart::KeyframeSpacing::by_motion, monitor);
      text = heart::sceneText(view, parameters, recording, "", look);
      meshes = meshesOf(heart::sceneOf(view, parameters, recording));
      meshes.heart_truth = heart::truthText(model, recording);
    });
  });
  return py::make_tuple(text, std::move(meshes));
}

py::list dialTable() {
  const heart::Parameters defaults;
  py::list table;
  for (const heart::Dial& dial : heart::dials())
    table.append(
        py::make_tuple(dial.key, dial.unit, dial.low, dial.high, dial.get(defaults), dial.meaning));
  return table;
}

py::list keyTable() {
  py::list table;
  for (const SceneKey& key : sceneKeys())
    table.append(py::make_tuple(key.fullName(), key.unit.symbol, key.accepted(), key.meaning));
  return table;
}

}  // namespace

void bindScene(py::module_& module) {
  py::class_<NativeScene>(module, "Scene", "The result of reading a scene's text.")
      .def(py::init(&read), py::arg("text"), py::arg("file"), py::arg("meshes").none(true),
           "Reads TOML; `meshes` None: keyframes are files beside `file`.")
      .def_property_readonly("absent", &absentKeys, "Absent keys -> default, or None.")
      .def_property_readonly("structures", &structures, "One dict per structure, in order.")
      .def_property_readonly("probe", &probe, "The probe in SI.")
      .def_property_readonly(
          "warnings", [](const NativeScene& n) { return n.scene.warnings; },
          "Warnings about valid but unlikely input, a line each.")
      .def_property_readonly(
          "frame_count", [](const NativeScene& n) { return CardiacClock(n.scene).frameCount(); },
          "Frames of the loop.")
      .def_property_readonly(
          "json", [](const NativeScene& n) { return sceneJson(n.scene).dump(); },
          "The resolved scene in SI units, as in the manifest.");
  module.def("heart", &makeHeart, py::arg("view"), py::arg("dials"), py::arg("segments"),
             py::arg("keep_volumes"), py::arg("keyframes"), py::arg("look"), py::arg("even"),
             py::arg("threads"), py::arg("progress").none(true),
             "A heart from its dials: its scene's text and its meshes.");
  module.def("scene_keys", &keyTable, "Full name, unit, accepted values, meaning of each key.");
  module.def("dials", &dialTable, "Key, unit, least, most, default or None, meaning of each dial.");
}

}  // namespace echocine::python
