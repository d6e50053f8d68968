#include "dataset/make_heart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "core/error.h"
#include "core/hash_random.h"
#include "core/parallel.h"
#include "core/units.h"
#include "dataset/aim.h"
#include "dataset/cavity_marks.h"
#include "dataset/redraw.h"
#include "dataset/structure_labels.h"
#include "dataset/tracing.h"
#include "frame/plan_loop.h"
#include "frame/simulator.h"
#include "frame/workspace.h"
#include "loop/render_frames.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/cycle/ecg.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/recording.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "output/truth_files.h"
#include "scene/scene_keys.h"
#include "scene/view_names.h"
#include "truth/frame_truth.h"
#include "truth/view_offset.h"

namespace echocine::dataset {

namespace {

using MarksAt = std::function<CavityMarks(const Simulator& simulator, double phase)>;

// For tests: makes a share of all hearts fail, by their numbers.
void failIfAsked(const Spec& spec, int heart) {
  const char* const share = std::getenv("ECHOCINE_FAILING_HEARTS");
  if (share == nullptr || uniformFromHash(hashFor(spec, "fault", heart, 0)) >= std::atof(share))
    return;
  throw JobError("made to fail by ECHOCINE_FAILING_HEARTS");
}

void keepContours(const Scene& scene, std::vector<Contour>& contours) {
  std::erase_if(contours, [&](const Contour& contour) {
    const Role role = roleOf(scene.structures[index(contour.surface)]);
    return std::find(std::begin(kContourRoles), std::end(kContourRoles), role) ==
           std::end(kContourRoles);
  });
}

// The sink of a loop that is a sample: pictures and truth of every frame, in order.
class SampleSink : public FrameSink {
 public:
  SampleSink(LoopSample& loop, SurfaceId cavity, bool all_labels)
      : loop_(loop), cavity_(loop.scene.structures[index(cavity)].name), all_labels_(all_labels) {}

  std::shared_ptr<void> take(MadeFrame& made) override {
    auto frame = std::make_shared<LoopFrame>();
    frame->time = made.time;
    std::swap(frame->image, made.workspace.image);
    frame->labels = std::move(made.truth->labels);
    if (all_labels_) {
      frame->structure_labels = frame->labels;
      for (std::uint8_t& label : frame->labels) label = camusLabel(label);
    }
    frame->contours = std::move(made.truth->contours);
    keepContours(loop_.scene, frame->contours);
    frame->function = made.truth->function;
    frame->tracks_m = std::move(made.truth->tracks_m);
    for (const auto& [name, ml] : made.volumes_ml)
      if (name == cavity_) frame->lv_ml = ml;
    return frame;
  }

  void inOrder(void* taken) override {
    const LoopFrame& frame = loop_.frames.emplace_back(std::move(*static_cast<LoopFrame*>(taken)));
    loop_.ecg.push_back(ecgAmplitude(frame.time.time_in_beat_s, frame.time.beat_s));
  }

 private:
  LoopSample& loop_;
  const std::string cavity_;
  const bool all_labels_;
};

// Within the first beat, and end-diastole before end-systole: CAMUS's half sequence runs from one
// to the other.
Instants instantsOf(const std::vector<LoopFrame>& frames) {
  const auto smaller = [](const LoopFrame& a, const LoopFrame& b) { return a.lv_ml < b.lv_ml; };
  const auto beat_end = std::find_if(frames.begin(), frames.end(),
                                     [](const LoopFrame& f) { return f.time.beat > 0; });
  const auto es = std::min_element(frames.begin(), beat_end, smaller);
  constexpr double kStill = 1.001;  // of the smallest volume; our choice
  if (es == frames.begin() && std::max_element(es, beat_end, smaller)->lv_ml > kStill * es->lv_ml)
    throw SceneError(
        "the left ventricle is smallest at the start of the loop: phase 0 must be end-diastole");
  const auto ed = std::max_element(frames.begin(), es + 1, smaller);
  return {static_cast<int>(ed - frames.begin()), static_cast<int>(es - frames.begin())};
}

Tracing inPixels(const PlaneTracing& traced, const PictureGeometry& geometry) {
  Tracing tracing{pixelOf(geometry, traced.apex), pixelOf(geometry, traced.base), {}};
  for (const auto& [from, to] : traced.chords)
    tracing.chords.emplace_back(pixelOf(geometry, from), pixelOf(geometry, to));
  return tracing;
}

// Volumes by Simpson's rule, and the tracing, of a frame at which the landmarks are known.
Tracing measure(const Simulator& simulator, SurfaceId cavity, const CavityMarks& marks,
                const PictureGeometry& geometry, bool is_short_axis, LoopFrame& frame) {
  const Pose& pose = simulator.scene().probe.pose;
  SurfaceFrame surfaces;
  simulator.motion().positionsAt(frame.time.phase, {&cavity, 1}, surfaces);
  const SurfaceTopology& surface = simulator.motion().surfaces()[index(cavity)];
  const std::vector<Vec3f>& positions = surfaces.positions_m[index(cavity)];
  const LongAxis axis{pose.fromWorld(marks.mitral), pose.fromWorld(marks.apex)};
  const auto widths = [&](Vec3d world) {  // in the heart's own four- and two-chamber directions
    const Vec3d across{dot(world, pose.x_axis), dot(world, pose.y_axis), dot(world, pose.z_axis)};
    return discWidths(surface.triangles, positions, axis, across);
  };
  const double length_m = length(axis.apex_m - axis.base_m);
  frame.biplane_ml = millilitresFromCubicMetres(
      discVolume(length_m, widths(marks.lateral), widths(marks.anterior)));
  if (is_short_axis) return {};
  const auto traced = traceCavity(longestContour(frame.contours, cavity), axis.base_m);
  if (!traced) return {};
  frame.disc_widths_m = traced->disc_widths_m;
  frame.traced_length_m = traced->length_m;
  frame.single_plane_ml = millilitresFromCubicMetres(
      discVolume(traced->length_m, traced->disc_widths_m, traced->disc_widths_m));
  return inPixels(*traced, geometry);
}

bool showsLongAxis(View view) {
  return view == View::a4c || view == View::a2c || view == View::a3c || view == View::plax;
}

// The outline of a short axis gives no volume, although it may come near the mitral ring.
bool isShortAxis(View view) {
  return view == View::psax_base || view == View::psax_mid || view == View::psax_apex;
}

void traceInstants(const Simulator& simulator, SurfaceId cavity, const MarksAt& marks_at,
                   LoopSample& loop) {
  for (const auto& [number, tracing] : {std::pair(loop.instants.ed, &loop.ed_tracing),
                                        std::pair(loop.instants.es, &loop.es_tracing)}) {
    LoopFrame& frame = loop.frames[static_cast<std::size_t>(number)];
    const CavityMarks marks = marks_at(simulator, frame.time.phase);
    Tracing made = measure(simulator, cavity, marks, loop.geometry, isShortAxis(loop.view), frame);
    if (showsLongAxis(loop.view)) *tracing = std::move(made);
  }
}

LoopSample makeLoop(const Spec& spec, const Draw& draw, std::size_t view, Scene scene,
                    const MarksAt& marks_at, const Monitor& monitor) {
  LoopSample loop;
  loop.view = spec.views[view];
  loop.id = loopId(draw.heart + 1, loop.view);
  loop.values = draw.valuesOf(view);
  loop.scene = std::move(scene);
  loop.geometry = pictureGeometry(loop.scene);
  refuseOutOfRange(loop.scene);
  const auto [placed, motion] = placedWithMotion(loop.scene);
  const Simulator simulator(placed, motion, planLoop(placed, *motion, PlanWords::without_warnings));
  const CardiacClock& clock = simulator.cardiacClock();
  if (spec.has("myotracker") && clock.frameCount() < kLeastTrackedFrames)  // of varied beats
    throw SceneError(fmt::format("a loop of {} frames, \"myotracker\" needs {}", clock.frameCount(),
                                 kLeastTrackedFrames));
  const SurfaceId cavity = *structureOf(loop.scene, Role::lv_cavity);
  SampleSink sink(loop, cavity, spec.nnunet_all);
  Monitor stop;  // progress is counted in hearts
  stop.keep_going = monitor.keep_going;
  if (renderFrames(simulator, {0, clock.frameCount()}, sink, stop) < clock.frameCount())
    throw JobError("stopped");
  loop.instants = instantsOf(loop.frames);
  for (int f = 0; f < static_cast<int>(loop.frames.size()); ++f)
    if (f != loop.instants.ed && f != loop.instants.es)
      loop.frames[static_cast<std::size_t>(f)].structure_labels = {};
  traceInstants(simulator, cavity, marks_at, loop);
  loop.tracked = simulator.truth()->tracked();
  loop.offset = simulator.truth()->view();  // there with functional truth only
  if (!loop.offset) loop.offset = viewOffset(simulator.scene(), simulator.motion());
  return loop;
}

void addUserLoops(const Spec& spec, const Draw& draw, const Monitor& monitor, Heart& made) {
  const MarksAt marks_at = [](const Simulator& simulator, double phase) {
    return marksOf(simulator.scene(), simulator.motion(), phase);
  };
  for (std::size_t v = 0; v < spec.views.size(); ++v)
    made.loops.push_back(makeLoop(spec, draw, v, sceneOf(spec, draw, v), marks_at, monitor));
}

void addLoops(const Spec& spec, const Draw& draw, const Monitor& monitor, Heart& made) {
  const heart::ParametricHeart model = modelOf(spec, draw.values);
  heart::Recording recording;
  const MarksAt marks_at = [&](const Simulator&, double phase) {
    return marksOf(recording, phase);
  };
  for (std::size_t v = 0; v < spec.views.size(); ++v) {
    if (v == 0)
      recording = recordBeat(model, spec.views[v], spec.keyframes);
    else
      recording.pose = poseOf(spec.views[v], recording);  // the same beat from elsewhere
    surroundProbe(spec, draw, v, model, recording);
    Scene scene = sceneOf(spec, draw, v, model.parameters(), recording);
    made.loops.push_back(makeLoop(spec, draw, v, std::move(scene), marks_at, monitor));
  }
}

Heart heartOf(const Spec& spec, const Draw& draw, const Monitor& monitor) {
  Heart made{draw.heart + 1, draw.attempt, draw.population->name, spec.splitOf(draw.heart), {}};
  (spec.scenes.empty() ? addLoops : addUserLoops)(spec, draw, monitor, made);
  return made;
}

}  // namespace

std::string loopId(int heart_number, View view) {
  std::string key = keyOf(view);
  std::replace(key.begin(), key.end(), '-', '_');
  return fmt::format("ec{:06}_{}", heart_number, key);
}

Heart makeHeart(const Spec& spec, int heart, const Monitor& monitor) {
  std::vector<std::string> impossible;
  std::optional<Heart> made;
  inThisThread([&] {
    failIfAsked(spec, heart);
    made = firstPossible(
        spec, heart, [&](const Draw& draw) { return heartOf(spec, draw, monitor); }, impossible);
  });
  made->impossible = std::move(impossible);
  return std::move(*made);
}

}  // namespace echocine::dataset
