#include "dataset/aim.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/units.h"
#include "dataset/cavity_marks.h"
#include "dataset/dataset_loop.h"
#include "dataset/structure_labels.h"
#include "dataset/user_scenes.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/recording.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/names.h"
#include "scene/probe_pose.h"
#include "scene/scene_reader.h"

namespace echocine::dataset {

namespace {

constexpr std::string_view kHeart = "heart.", kScene = "scene.", kSegments = "heart.segments.";
constexpr const char* kRule = "heart.rule";  // "volumes", as in `echocine heart --rule`

double numberAt(const Values& values, const std::string& name, double fallback) {
  const auto found = values.find(name);
  return found == values.end() ? fallback : numberIn(found->second).value();
}

// "lad.amplitude" of some segments.
void setSegments(std::string_view rest, double value, heart::Parameters& parameters) {
  const std::size_t dot = rest.find('.');
  const bool delay = rest.substr(dot + 1) == "delay_ms";
  for (const int number : segmentsOf(rest.substr(0, dot))) {
    heart::Segment& segment = parameters.segments[static_cast<std::size_t>(number - 1)];
    (delay ? segment.delay_s : segment.amplitude) = delay ? 1e-3 * value : value;
  }
}

// Rodrigues' rotation of a vector about a unit axis.
Vec3d turned(Vec3d v, Vec3d axis, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

void turn(Pose& pose, Vec3d axis, double angle_rad) {
  pose.x_axis = turned(pose.x_axis, axis, angle_rad);
  pose.y_axis = turned(pose.y_axis, axis, angle_rad);
  pose.z_axis = turned(pose.z_axis, axis, angle_rad);
}

// Turns the imaging plane about the line through the middle of the mitral ring along the lateral
// axis, so that it misses the ventricle's apex by so many metres: the long axis is foreshortened.
void missApex(double miss_m, const CavityMarks& marks, Pose& pose) {
  const Vec3d mitral = pose.fromWorld(marks.mitral), apex = pose.fromWorld(marks.apex);
  const double reach_m = std::abs(apex.z - mitral.z);
  if (miss_m == 0 || !(reach_m > 0)) return;
  const double angle_rad = std::asin(std::clamp(miss_m / reach_m, -1.0, 1.0));
  const Vec3d about = pose.x_axis, pivot = pose.origin + mitral.z * pose.z_axis;
  turn(pose, about, angle_rad);
  pose.origin = pivot + turned(pose.origin - pivot, about, angle_rad);
}

// The operator's hand: shifted along the probe's axes, then turned about its apex as by the scene
// keys rotate_deg and tilt_deg of `probe`.
void moveProbe(const Values& values, const CavityMarks& marks, Pose& pose) {
  missApex(1e-3 * numberAt(values, "offset.apex_miss_mm", 0), marks, pose);
  pose.origin = pose.origin + 1e-3 * numberAt(values, "offset.shift_lateral_mm", 0) * pose.x_axis +
                1e-3 * numberAt(values, "offset.shift_elevation_mm", 0) * pose.y_axis +
                1e-3 * numberAt(values, "offset.shift_depth_mm", 0) * pose.z_axis;
  pose = turnedAndTilted(pose, radiansFromDegrees(numberAt(values, "offset.rotate_deg", 0)),
                         radiansFromDegrees(numberAt(values, "offset.tilt_deg", 0)));
}

// Seeds that nobody named belong to the heart (what its tissue is) or to the view.
void setSeeds(const Spec& spec, const Draw& draw, int view, const Values& given, Scene& scene) {
  const auto set = [&](const char* key, int& seed, int of_view) {
    if (given.count(key) > 0) return;
    seed = static_cast<int>(hashFor(spec, key, draw.heart, draw.attempt, of_view) >> 34);
  };
  set("scene.acquisition.seed", scene.acquisition.seed, -1);
  set("scene.speckle.heterogeneity_seed", scene.speckle.heterogeneity_seed, -1);
  set("scene.trabeculae.seed", scene.trabeculae.seed, -1);
  set("scene.speckle.seed", scene.speckle.seed, view);
  set("scene.artefacts.clutter_seed", scene.artefacts.clutter_seed, view);
  set("scene.artefacts.noise_seed", scene.artefacts.noise_seed, view);
  set("scene.artefacts.shading_seed", scene.artefacts.shading_seed, view);
}

// The picture is the sector's bounding square, fine enough for the resolution that the spec asks
// for. Its side is a multiple of 112 then, EchoNet's size.
int pictureSide(const Spec& spec, const Probe& probe) {
  if (spec.resolution_mm == 0) return spec.picture_px;
  constexpr int kUnit = 112;
  constexpr double kMargins = 0.96;  // of the picture that the sector fills (signal/picture.h)
  const double half_m = probe.max_depth_m * std::sin(std::min(probe.last_angle_rad, 1.5707963));
  const double extent_m = std::max(2 * half_m, probe.max_depth_m);
  const double least_px = extent_m / (1e-3 * spec.resolution_mm) / kMargins;
  return std::max(spec.picture_px, kUnit * static_cast<int>(std::ceil(least_px / kUnit)));
}

void setOutput(const Spec& spec, Scene& scene) {
  scene.output = {};
  scene.output.exr = scene.output.report = scene.output.ecg = scene.output.depth_ticks = false;
  scene.output.width = scene.output.height = pictureSide(spec, scene.probe);
  scene.truth.contours = true;
  scene.truth.labels = (spec.has("native") && spec.wants("labels")) || spec.has("camus") ||
                       spec.has("nnunet") || spec.has("pointodyssey");
  scene.truth.visible_roles = {Role::lv_cavity};  // for loops.csv
  if (spec.has("native") && spec.wants("contours"))
    scene.truth.visible_roles.assign(std::begin(kContourRoles), std::end(kContourRoles));
  scene.truth.papillary_in_cavity = true;  // as laboratories trace it
  scene.truth.label_numbers = {{"lv_cavity", 1}, {"lv_wall", 2}, {"la", 3}};
  if (spec.nnunet_all) {  // reduced to those three in each frame
    scene.truth.papillary_in_cavity = false;
    scene.truth.label_numbers = structureNumbers();
  }
  scene.truth.tracks = spec.wantsTracks();
  scene.truth.function = spec.wants("function");
  scene.truth.track_count = spec.track_count;
}

std::vector<std::pair<std::string, TomlValue>> sceneKeys(const Values& all) {
  std::vector<std::pair<std::string, TomlValue>> keys;
  for (const auto& [name, value] : all)
    if (name.starts_with(kScene)) keys.emplace_back(name.substr(kScene.size()), value);
  return keys;
}

// To find by tracing that a heart's rays hardly bend takes as long as tracing its loop: they are
// straight unless the spec or a user's scene says otherwise.
void straightenRays(const Values& all, Scene& scene) {
  if (all.count("scene.effects.refraction") == 0 && scene.effects.refraction == Switch::automatic)
    scene.effects.refraction = Switch::off;
}

// Names of values of segments, in the order in which they are set.
std::vector<std::string> segmentValues(const Spec& spec, const Values& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values)
    if (name.starts_with(kSegments)) names.push_back(name);
  const auto rank = [&](const std::string& name) {
    const std::string rest = name.substr(kSegments.size());
    const std::size_t segments = segmentsOf(rest.substr(0, rest.find('.'))).size();
    return std::pair(spec.gives(name), -static_cast<int>(segments));
  };
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return rank(a) < rank(b); });
  return names;
}

heart::Parameters parametersOf(const Spec& spec, const Values& values) {
  std::map<std::string, double> dials;
  for (const auto& [name, value] : values)
    if (name.starts_with(kHeart) && !name.starts_with(kSegments) && name != kRule)
      dials[name.substr(kHeart.size())] = numberIn(value).value();
  heart::Parameters parameters = heart::parametersFrom(dials);
  parameters.volumes_rule = values.count(kRule) > 0;
  for (const std::string& name : segmentValues(spec, values))
    setSegments(std::string_view(name).substr(kSegments.size()), numberIn(values.at(name)).value(),
                parameters);
  return parameters;
}

}  // namespace

heart::ParametricHeart modelOf(const Spec& spec, const Values& values) {
  const heart::Parameters parameters = parametersOf(spec, values);
  if (const std::string fault = faultOf(parameters); !fault.empty()) throw SceneError(fault);
  return heart::ParametricHeart(parameters);
}

void surroundProbe(const Spec& spec, const Draw& draw, std::size_t view,
                   const heart::ParametricHeart& model, heart::Recording& recording) {
  const Values all = draw.valuesOf(view);
  const heart::ProbePose& held = recording.pose;
  Pose pose = *poseOf(held.apex, held.axis, held.lateral);
  moveProbe(all, marksOf(recording, 0), pose);
  heart::ProbePose moved = held;
  moved.apex = pose.origin;
  moved.axis = pose.z_axis;
  moved.lateral = pose.x_axis;
  // Pressed in, the chest is thinner; a millimetre is always left (our choice).
  moved.chest_m = std::max(0.001, held.chest_m - 1e-3 * numberAt(all, "offset.shift_depth_mm", 0));
  surround(spec.views[view], moved, model, recording);
}

Scene sceneOf(const Spec& spec, const Draw& draw, std::size_t view) {
  const Values all = draw.valuesOf(view);
  Scene scene = userScene(spec, draw, spec.views[view], sceneKeys(all));
  straightenRays(all, scene);
  CavityMarks marks;
  if (numberAt(all, "offset.apex_miss_mm", 0) != 0) marks = marksOf(scene, MeshMotion(scene), 0);
  moveProbe(all, marks, scene.probe.pose);
  setSeeds(spec, draw, static_cast<int>(spec.views[view]), all, scene);
  setOutput(spec, scene);
  return scene;
}

Scene sceneOf(const Spec& spec, const Draw& draw, std::size_t view,
              const heart::Parameters& parameters, const heart::Recording& recording) {
  const Values all = draw.valuesOf(view);
  const std::string name = loopId(draw.heart + 1, spec.views[view]);
  const auto look = all.find("scene.signal.look");
  const Look wanted =
      look == all.end() ? Look::scanner
                        : valueOf<Look>(std::get<std::string>(look->second)).value_or(Look::paper);
  const std::string text = withValues(
      heart::sceneText(spec.views[view], parameters, recording, "", wanted), name, sceneKeys(all));
  Scene scene = parseScene(text, name, heart::meshesOf(recording));
  straightenRays(all, scene);
  moveProbe(all, marksOf(recording, 0), scene.probe.pose);
  setSeeds(spec, draw, static_cast<int>(spec.views[view]), all, scene);
  setOutput(spec, scene);
  return scene;
}

}  // namespace echocine::dataset
