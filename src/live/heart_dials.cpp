#include "live/heart_dials.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "live/mesh_paths.h"
#include "motion/heart/left_ventricle.h"
#include "output/heart_files.h"
#include "scene/toml_edit.h"

namespace echocine::live {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr std::size_t kMostTruthBytes = 4 << 20;  // `echocine heart` writes under 100 kB

// Where the folder of a keyframes pattern is in a text.
struct FolderPlace {
  std::size_t at = 0, size = 0;
};

// One for each line `keyframes = "FOLDER/PATTERN.obj"` or `keyframes = "FOLDER/NAME.npz"`.
std::vector<FolderPlace> folderPlaces(const std::string& text) {
  std::vector<FolderPlace> places;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    const std::size_t key = line.find_first_not_of(" \t"), open = line.find('"');
    if (key != std::string_view::npos && line.substr(key).starts_with("keyframes") &&
        open != std::string_view::npos) {
      const std::size_t close = line.find('"', open + 1);
      const std::string_view between = line.substr(key + 9, open - key - 9);
      if (close != std::string_view::npos &&
          between.find_first_not_of(" \t=") == std::string_view::npos) {
        const std::string_view value = line.substr(open + 1, close - open - 1);
        const std::size_t slash = value.rfind('/');
        places.push_back({begin + open + 1, slash == std::string_view::npos ? 0 : slash + 1});
      }
    }
    begin = end + 1;
  }
  return places;
}

// The folder of all keyframes, if it is one.
std::optional<fs::path> folderOf(const Scene& scene, const std::string& text) {
  const std::vector<FolderPlace> places = folderPlaces(text);
  if (places.empty() || places.size() != scene.structures.size()) return std::nullopt;
  const std::string first = text.substr(places.front().at, places.front().size);
  for (const FolderPlace& place : places)
    if (text.substr(place.at, place.size) != first) return std::nullopt;
  return scene.file.parent_path() / first;
}

// Empty without a file that can be read.
std::string truthIn(const fs::path& folder) {
  std::error_code failed;
  if (!fs::is_regular_file(folder / "truth.json", failed)) return {};
  try {
    return readTextFile(folder / "truth.json", kMostTruthBytes);
  } catch (const SceneError&) {
    return {};
  }
}

std::optional<std::map<std::string, double>> dialsOf(const Json& parameters) {
  std::map<std::string, double> values;
  for (const heart::Dial& dial : heart::dials()) {
    if (heart::isShapeDial(dial.key) && !parameters.contains(dial.key)) continue;
    if (!parameters.contains(dial.key)) return std::nullopt;
    const Json& entry = parameters[dial.key];
    if (!entry.is_null()) values[dial.key] = entry.at("value").get<double>();
  }
  return values;
}

// The dialled ejection fraction of a heart that ejects `ejected` because of its segments: a truth
// has the latter. Secant steps; the ejected fraction grows with the dialled one.
double dialledEjection(heart::Parameters parameters, double ejected) {
  const auto excess = [&](double dialled) {
    parameters.ejection_fraction = dialled;
    return heart::LeftVentricle::ejectionFractionOf(parameters) - ejected;
  };
  double before = ejected, excess_before = excess(before), dialled = before - excess_before;
  for (int i = 0; i < 8 && std::abs(dialled - before) > 1e-7; ++i) {
    const double here = excess(dialled);
    if (here == excess_before) break;
    const double next = dialled - here * (dialled - before) / (here - excess_before);
    before = std::exchange(dialled, next);
    excess_before = here;
  }
  return std::round(1e5 * dialled) / 1e5;
}

// Without dials that follow others, so that they follow a change, too.
std::map<std::string, double> withoutFollowers(std::map<std::string, double> given) {
  for (const char* key : {"mapse", "twist", "rv-edv"}) {
    const double value = given.at(key);
    auto fewer = given;
    fewer.erase(key);
    const heart::Parameters parameters = heart::parametersFrom(fewer);
    for (const heart::Dial& dial : heart::dials())
      if (std::string_view(dial.key) == key &&
          std::abs(dial.get(parameters).value_or(NAN) - value) <= 1e-9 * std::abs(value))
        given = fewer;
  }
  return given;
}

bool isEven(const std::vector<double>& phases) {
  for (std::size_t k = 0; k < phases.size(); ++k)
    if (std::abs(phases[k] - static_cast<double>(k) / static_cast<double>(phases.size())) > 2e-6)
      return false;
  return true;
}

// Small for poses that show the same: 10 mm weigh as much as 10 degrees.
double differenceOf(const Pose& pose, const heart::ProbePose& other) {
  const auto angle = [](Vec3d a, Vec3d b) { return std::acos(std::clamp(dot(a, b), -1.0, 1.0)); };
  return length(pose.origin - other.apex) / 0.01 +
         (angle(pose.z_axis, other.axis) + angle(pose.x_axis, other.lateral)) / 0.1745;
}

// A dial of the whole body is none of a page.
bool isOnPage(const heart::Dial& dial) {
  return std::string_view(dial.key) != "body-scale";
}

// The timing of a recording as keys. The scene keeps its own rate unless a rate is asked for.
std::vector<TomlEdit> timingOf(const heart::Recording& recording, std::optional<double> rate_bpm) {
  std::string phases;
  for (const double phase : recording.phases)
    phases += fmt::format("{}{:.6f}", phases.empty() ? "" : ", ", phase);
  std::vector<TomlEdit> edits{
      {"motion.end_systole_phase", fmt::format("{:.6f}", recording.end_systole_phase)},
      {"motion.keyframe_phases", "[" + phases + "]"}};
  if (!rate_bpm) return edits;
  const std::string rate = fmt::format("{}", *rate_bpm);
  edits.push_back({"acquisition.heart_rate_bpm", rate});
  edits.push_back({"motion.keyframe_heart_rate_bpm", rate});
  return edits;
}

}  // namespace

std::string HeartChange::name() const {
  std::string name;
  for (const auto& [key, value] : dials) name += fmt::format("{}={} ", key, value);
  for (const auto& [segment, amplitude] : segments)
    name += fmt::format("{}:{} ", segment, amplitude);
  return name;
}

bool HeartDials::readTruth(const std::string& truth) {
  try {
    const Json parameters = Json::parse(truth).at("parameters");
    auto values = dialsOf(parameters);
    if (!values) return false;
    heart::Parameters read = heart::parametersFrom(*values);
    const Json& segments = parameters.at("segments");
    for (std::size_t s = 0; s < heart::kSegments; ++s)
      read.segments[s] = {segments.at(s).at("amplitude").get<double>(),
                          1e-3 * segments.at(s).at("delay_ms").get<double>()};
    read.volumes_rule = parameters.at("rule") == "volumes";
    if (!read.volumes_rule && std::any_of(read.segments.begin(), read.segments.end(),
                                          [](const auto& s) { return s.amplitude != 1; }))
      (*values)["ef"] = dialledEjection(read, read.ejection_fraction);
    given_ = withoutFollowers(*values);
    parameters_ = heart::parametersFrom(given_);
    parameters_.segments = read.segments;
    parameters_.volumes_rule = read.volumes_rule;
  } catch (const std::exception&) {  // JSON of another kind
    return false;
  }
  return heart::faultOf(parameters_).empty();
}

std::optional<HeartDials> HeartDials::of(const Scene& scene, const std::string& text,
                                         const std::string& truth) {
  const std::optional<fs::path> folder = folderOf(scene, text);
  if (!folder || scene.motion.mesh_unit_m != 1e-3 || scene.motion.mesh_offset_m != Vec3d{})
    return std::nullopt;
  HeartDials made;
  if (!made.readTruth(truth.empty() ? truthIn(*folder) : truth)) return std::nullopt;
  for (const Structure& structure : scene.structures)
    made.keyframes_ = std::max(made.keyframes_, static_cast<int>(structure.keyframes.size()));
  if (made.keyframes_ < 4) return std::nullopt;
  if (isEven(scene.motion.keyframe_phases)) made.spacing_ = heart::KeyframeSpacing::even;
  made.pose_ = scene.probe.pose;
  made.file_ = scene.file.string();
  return made;
}

Json HeartDials::json(const HeartChange& change) const {
  const heart::Parameters parameters = parametersWith(change);
  Json list = Json::array(), segments = Json::array();
  for (const heart::Dial& dial : heart::dials()) {
    if (!isOnPage(dial)) continue;
    const auto value = dial.get(parameters);
    list.push_back({{"key", dial.key},
                    {"unit", dial.unit},
                    {"lo", dial.low},
                    {"hi", dial.high},
                    {"value", value ? Json(*value) : Json()},
                    {"meaning", dial.meaning}});
  }
  for (const heart::Segment& segment : parameters.segments) segments.push_back(segment.amplitude);
  return {{"dials", list}, {"segments", segments}};
}

heart::Parameters HeartDials::parametersWith(const HeartChange& change) const {
  std::map<std::string, double> given = given_;
  const auto dials = heart::dials();
  for (const auto& [key, value] : change.dials) {
    const auto dial = std::find_if(dials.begin(), dials.end(),
                                   [&key = key](const auto& d) { return key == d.key; });
    if (dial == dials.end() || !isOnPage(*dial))
      throw SceneError(fmt::format("dials: {} is not a dial of the heart", key));
    given[key] = value;
  }
  heart::Parameters parameters = heart::parametersFrom(given);
  parameters.segments = parameters_.segments;
  parameters.volumes_rule = parameters_.volumes_rule;
  for (const auto& [segment, amplitude] : change.segments) {
    if (segment < 1 || segment > heart::kSegments)
      throw SceneError(fmt::format("segments: {}, accepted: 1 to {}", segment, heart::kSegments));
    parameters.segments[static_cast<std::size_t>(segment - 1)].amplitude = amplitude;
  }
  if (const std::string fault = heart::faultOf(parameters); !fault.empty())
    throw SceneError("heart: " + fault);
  return parameters;
}

const HeartDials::Own& HeartDials::own() const {
  std::call_once(own_->once, [&] {
    const heart::ParametricHeart model(parameters_);
    heart::Recording recording = heart::recordBeat(model, heart::View::a4c, keyframes_, spacing_);
    double least = INFINITY;
    for (const ViewName& name : viewNames()) {
      const heart::ProbePose pose = heart::poseOf(name.view, recording);
      const double difference = differenceOf(pose_, pose);
      if (difference >= least) continue;
      least = difference;
      own_->view = name.view;
      own_->standard = pose;
    }
  });
  return *own_;
}

const heart::ProbePose& HeartDials::ownStandard() const {
  return own().standard;
}

OtherHeart HeartDials::made(const HeartChange& change, const std::string& text) const {
  const heart::Parameters parameters = parametersWith(change);
  const heart::ParametricHeart model(parameters);
  const heart::Recording recording = heart::record(model, own().view, keyframes_, spacing_);
  const auto rate = change.dials.find("hr");
  OtherHeart other;
  other.text = withEdits(
      withNamesInMemory(withFolder(text, ""), recording),
      timingOf(recording, rate == change.dials.end() ? std::nullopt : std::optional(rate->second)),
      file_);
  other.meshes = heart::meshesOf(recording);
  other.standard = recording.pose;
  return other;
}

void HeartDials::write(const HeartChange& change, const fs::path& folder) const {
  HeartFiles files;
  files.parameters = parametersWith(change);
  files.view = own().view;
  files.keyframes = keyframes_;
  files.spacing = spacing_;
  writeHeart(files, folder);
}

std::string HeartDials::withFolder(const std::string& text, const std::string& folder) {
  std::string changed = text;
  const std::vector<FolderPlace> places = folderPlaces(text);
  for (auto place = places.rbegin(); place != places.rend(); ++place)
    changed.replace(place->at, place->size, folder);
  return changed;
}

}  // namespace echocine::live
